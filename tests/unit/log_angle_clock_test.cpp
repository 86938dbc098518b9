// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Reading a channel between its samples, and an angle by the clock of the torques, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "log/angle_clock.hpp"
#include "log/read_between.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kPeriod_s = 0.01;

/// What a wheel does: tones of 0.3 to 20 Hz, faster than any wheel.
double motion_rad(double t) {
  double sum = 0;
  for (const double hz : {0.3, 1.7, 4.1, 9.3, 20.0}) sum += 0.1 * std::cos(2 * std::numbers::pi * hz * t + hz);
  return sum;
}

TEST(ReadBetween, FindsTheMotionBetweenItsSamples) {
  std::vector<double> values;
  for (int i = 0; i < 200; ++i) values.push_back(motion_rad(kPeriod_s * i));
  for (double place = 32; place < 167; place += 0.37) {
    EXPECT_NEAR(read_between(values, place), motion_rad(kPeriod_s * place), 2e-4) << place;
  }
  EXPECT_EQ(read_between(values, 3.0), values[3]);  // a sample is itself, however near the end
  EXPECT_TRUE(std::isnan(read_between(values, 3.5)));
  EXPECT_TRUE(std::isnan(read_between(values, 190.5)));
  EXPECT_TRUE(std::isnan(read_between(values, -0.5)));
  EXPECT_TRUE(std::isnan(read_between(values, 200.0)));
}

/// A tone passes with a gain of one up to 46 % of the sampling rate, half-way between two samples, where a cubic
/// through four has lost most of it.
TEST(ReadBetween, KeepsNoiseWhite) {
  for (const double share : {0.05, 0.2, 0.3, 0.4, 0.45, 0.46}) {
    std::vector<double> cosine;
    std::vector<double> sine;
    for (int i = 0; i < 100; ++i) {
      cosine.push_back(std::cos(2 * std::numbers::pi * share * i));
      sine.push_back(std::sin(2 * std::numbers::pi * share * i));
    }
    EXPECT_NEAR(std::norm(std::complex(read_between(cosine, 50.5), read_between(sine, 50.5))), 1, 0.01) << share;
  }
}

/// A record whose angle comes later by `later_per_s` every second, with a hole of two seconds.
Record drifting(double later_per_s) {
  Record record;
  for (int i = 0; i < 6000; ++i) {
    if (i >= 2000 && i < 2200) continue;
    const double t = kPeriod_s * i;
    record.time_s.push_back(5 + t);
    record.torque_driver_nm.push_back(i);
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(motion_rad(t - later_per_s * t / (1 + later_per_s)));
  }
  return record;
}

TEST(AngleClock, ReadsTheAngleWhereTheTorquesClockHasIt) {
  for (const double later_per_s : {3e-4, -3e-4}) {
    const Record read = by_one_clock(drifting(later_per_s), {.later_per_s = later_per_s}, {});
    ASSERT_GT(read.size(), 5800U - 4U * 35U);  // the read's reach at both ends of both stretches
    ASSERT_LT(read.size(), 5800U);
    for (std::size_t i = 0; i < read.size(); ++i) {
      const double t = read.time_s[i] - 5;
      ASSERT_NEAR(read.angle_rad[i], motion_rad(t), 3e-4) << t;
      ASSERT_EQ(read.torque_driver_nm[i], std::round(100 * t));
      ASSERT_FALSE(t > 19.99 && t < 22);
    }
  }
}

TEST(AngleClock, LeavesARecordOfOneClockAsItIs) {
  const Record record = drifting(0);
  EXPECT_EQ(by_one_clock(record, {}, {}).angle_rad, record.angle_rad);
  EXPECT_EQ(by_one_clock(Record{}, {.later_per_s = 1e-4}, {}).size(), 0U);
}

}  // namespace
}  // namespace steerid
