// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "sensors/sensor_suite.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kSigmas = 4.5;

/// All three channels run as straight lines through 0 with these slopes.
TickSignals ramps(int tick, double driver, double motor, double angle) {
  const double t = tick * 0.01;
  return {{driver * t, driver, 0, 0}, {motor * t, motor, 0, 0}, {angle * t, angle, 0, 0}};
}

TEST(SensorSuite, WithoutDefectsReadsTheTruthAtTheTick) {
  SensorSuite suite(SensorDefects::none(), 1);
  for (int k = 0; k < 100; ++k) {
    const Measurement m = suite.read(ramps(k, 1.0, -2.0, 0.5));
    ASSERT_EQ(m.stamp_us, k * kTickPeriodUs);
    ASSERT_EQ(m.torque_driver_nm, k * 0.01);
    ASSERT_EQ(m.torque_motor_nm, -2.0 * (k * 0.01));
    ASSERT_EQ(m.angle_rad, 0.5 * (k * 0.01));
    ASSERT_EQ(m.valid_bits, kAllChannelsValid);
    ASSERT_TRUE(m.delivered);
  }
}

TEST(SensorSuite, StampedJitterMovesTheInstantAndSaysSo) {
  SensorDefects defects;
  defects.jitter = {.spread_us = 4'000, .stamped = true, .during = {}};
  SensorSuite suite(defects, test::seed(20));
  constexpr int kCount = 50'000;
  double sum = 0;
  double squares = 0;
  std::int64_t last_us = -1;
  for (int k = 0; k < kCount; ++k) {
    const Measurement m = suite.read(ramps(k, 0, 0, 2.0));
    const auto late_us = static_cast<double>(m.stamp_us - k * kTickPeriodUs);
    ASSERT_GE(late_us, 0.0);
    ASSERT_LE(late_us, 4'000.0);
    ASSERT_GT(m.stamp_us, last_us);
    last_us = m.stamp_us;
    ASSERT_NEAR(m.angle_rad, 2.0 * static_cast<double>(m.stamp_us) * 1e-6, 1e-9);
    sum += late_us - 2'000.0;
    squares += (late_us - 2'000.0) * (late_us - 2'000.0);
  }
  // Uniform over 4001 whole microseconds; the variance of its square is (1/80 - 1/144) of the fourth power of its
  // width.
  const double sd = 4'001.0 / std::sqrt(12.0);
  EXPECT_NEAR(sum / kCount, 0.0, kSigmas * sd / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, sd * sd,
              kSigmas * std::sqrt(1.0 / 80 - 1.0 / 144) * 4'001.0 * 4'001.0 / std::sqrt(kCount));
}

TEST(SensorSuite, HiddenJitterIsAnErrorInProportionToTheSlope) {
  SensorDefects defects;
  defects.jitter = {.spread_us = 2'000, .stamped = false, .during = {}};
  SensorSuite suite(defects, test::seed(21));
  constexpr int kCount = 50'000;
  constexpr double kSlope = 3.0;
  double sum = 0;
  double squares = 0;
  for (int k = 0; k < kCount; ++k) {
    const Measurement m = suite.read(ramps(k, 0, 0, kSlope));
    ASSERT_EQ(m.stamp_us, k * kTickPeriodUs + 1'000);
    const double error = m.angle_rad - kSlope * static_cast<double>(m.stamp_us) * 1e-6;
    sum += error;
    squares += error * error;
  }
  const double sd = kSlope * 2'001e-6 / std::sqrt(12.0);
  EXPECT_NEAR(sum / kCount, 0.0, kSigmas * sd / std::sqrt(kCount));
  EXPECT_NEAR(std::sqrt(squares / kCount) / sd, 1.0, kSigmas * 0.45 / std::sqrt(kCount));  // sd of u^2/var/2 is 0.447
}

TEST(SensorSuite, LosesWholeMessages) {
  SensorDefects defects;
  defects.message_loss = {.fraction = 0.2, .mean_run = 1, .flagged = false, .during = {.onset_s = 10, .length_s = 100}};
  SensorSuite suite(defects, test::seed(22));
  int lost = 0;
  for (int k = 0; k < 20'000; ++k) {
    const bool delivered = suite.read(ramps(k, 0, 0, 1)).delivered;
    if (k < 1'000 || k >= 11'000) {
      ASSERT_TRUE(delivered);
    }
    if (!delivered) ++lost;
  }
  EXPECT_NEAR(lost, 2'000, kSigmas * std::sqrt(10'000 * 0.2 * 0.8));
}

TEST(SensorSuite, ChancesOfTheChannelsAreIndependent) {
  const std::uint64_t seed = test::seed(23);
  SensorSuite all(SensorDefects::realistic(), seed);
  SensorDefects angle_only;
  angle_only.angle = SensorDefects::realistic().angle;
  SensorSuite alone(angle_only, seed);
  constexpr int kCount = 20'000;
  double products[3] = {};
  double squares[3] = {};
  for (int k = 0; k < kCount; ++k) {
    const Measurement m = all.read({});
    ASSERT_EQ(m.angle_rad, alone.read({}).angle_rad) << "the angle's noise depends on the torques'";
    products[0] += m.torque_driver_nm * m.torque_motor_nm;
    products[1] += m.torque_driver_nm * m.angle_rad;
    products[2] += m.torque_motor_nm * m.angle_rad;
    squares[0] += m.torque_driver_nm * m.torque_driver_nm;
    squares[1] += m.torque_motor_nm * m.torque_motor_nm;
    squares[2] += m.angle_rad * m.angle_rad;
  }
  const double limit = kSigmas / std::sqrt(kCount);
  EXPECT_NEAR(products[0] / std::sqrt(squares[0] * squares[1]), 0.0, limit);
  EXPECT_NEAR(products[1] / std::sqrt(squares[0] * squares[2]), 0.0, limit);
  EXPECT_NEAR(products[2] / std::sqrt(squares[1] * squares[2]), 0.0, limit);
}

TEST(SensorSuite, RoundsToThePortsIntegers) {
  Measurement m{.stamp_us = 12'340'000, .torque_driver_nm = -1.2346, .torque_motor_nm = 5.0, .angle_rad = 0.1234567};
  m.valid_bits = kAngleValid;
  const Sample sample = to_sample(m, 7);
  EXPECT_EQ(sample.stamp_us, 12'340'000);
  EXPECT_EQ(sample.torque_driver_mnm, -1235);
  EXPECT_EQ(sample.torque_motor_mnm, 5000);
  EXPECT_EQ(sample.angle_urad, 123457);
  EXPECT_EQ(sample.sequence, 7);
  EXPECT_EQ(sample.valid_bits, kAngleValid);
  m.angle_rad = 1e9;
  m.torque_driver_nm = -1e9;
  EXPECT_EQ(to_sample(m, 0).angle_urad, std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(to_sample(m, 0).torque_driver_mnm, std::numeric_limits<std::int32_t>::min());
}

}  // namespace
}  // namespace steerid
