// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What passes for a sensor's noise: normal noise does, and neither rounding nor lost samples.
#include "gap/likelihood/noise_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "gap/drawn_drive.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// A wheel that is driven at 0.4 Hz, and its run.
struct Drive {
  Record record;
  std::vector<double> run_rad;
};

Drive slow_drive(int samples) {
  Drive drive;
  for (int i = 0; i < samples; ++i) {
    drive.record.time_s.push_back(0.01 * i);
    drive.run_rad.push_back(0.2 * std::sin(2.5 * 0.01 * i));
  }
  drive.record.angle_rad = drive.run_rad;
  drive.record.torque_driver_nm.assign(drive.run_rad.size(), 0.0);
  drive.record.torque_motor_nm.assign(drive.run_rad.size(), 0.0);
  return drive;
}

/// Of noise that `draw` makes, in the record of a drive of 80 s.
template <typename Draw>
double departure(const Draw& draw) {
  Drive drive = slow_drive(8000);
  for (double& angle : drive.record.angle_rad) angle += draw();
  return departure_from_normal(drive.record, drive.run_rad);
}

TEST(NoiseShape, NormalNoiseIsWithinChance) {
  std::mt19937_64 engine(test::seed(95));
  std::normal_distribution<double> normal(0, 0.0006);
  // The larger of two sizes of a normal number: above 4.5 once in 70,000.
  EXPECT_LT(departure([&] { return normal(engine); }), 4.5);
}

TEST(NoiseShape, NormalNoiseOfAFineLatticeIsWithinChance) {
  std::mt19937_64 engine(test::seed(96));
  std::normal_distribution<double> normal(0, 0.0006);
  EXPECT_LT(departure([&] { return 0.0005 * std::round(normal(engine) / 0.0005); }), 4.5);
}

TEST(NoiseShape, UniformNoiseIsNot) {
  test::Noise noise(test::seed(97));
  // Its kurtosis is 1.8. Of an ideal high pass that takes the lower 30 % away the middle tap has 0.7 of the power: at
  // least half of the 1.2 is left, 0.6/sqrt(24/8000) = 11 deviations; all of it would be 22.
  const double found = departure([&] { return 0.002 * (noise.uniform() - 0.5); });
  EXPECT_GT(found, 8);
  EXPECT_LT(found, 22);
}

TEST(NoiseShape, TheRoundingOfASlowMotionIsNot) {
  Drive drive = slow_drive(8000);
  for (double& angle : drive.record.angle_rad) angle = 0.05 * std::round(angle / 0.05);
  EXPECT_GT(departure_from_normal(drive.record, drive.run_rad), 30);
}

TEST(NoiseShape, LostSamplesAreNot) {
  test::Noise noise(test::seed(98));
  Drive drive = slow_drive(8000);
  for (std::size_t i = 1; i < drive.run_rad.size(); ++i) {
    if (noise.uniform() < 0.05) drive.record.angle_rad[i] = drive.record.angle_rad[i - 1];
  }
  for (double& angle : drive.record.angle_rad) angle += 0.0003 * noise();
  EXPECT_GT(departure_from_normal(drive.record, drive.run_rad), 30);
}

TEST(NoiseShape, AFewSamplesSayNothing) {
  Drive drive = slow_drive(400);
  for (double& angle : drive.record.angle_rad) angle = 0.05 * std::round(angle / 0.05);
  EXPECT_EQ(departure_from_normal(drive.record, drive.run_rad), 0);
}

}  // namespace
}  // namespace steerid
