// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which readings are a frozen sensor's, and which are those of a wheel that rests, of a torque that is commanded and
// held, and of a limit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "log/frozen_channels.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

using std::numbers::pi;

double rounded(double value, double step) { return std::round(value / step) * step; }

/// 30 s at 100 Hz of a wheel that moves slowly, or rests from 10 to 14 s: noise and rounding in steps, both in rad.
Record turning(double noise, double step, bool rests) {
  std::mt19937_64 random(seed(31));
  std::normal_distribution<double> normal;
  Record record;
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.01 * i;
    const double angle = 0.2 * std::sin(2 * pi * 0.7 * (rests && t > 10 ? 10 + std::max(0.0, t - 14) : t));
    record.time_s.push_back(t);
    record.angle_rad.push_back(rounded(angle + noise * normal(random), step));
    record.torque_motor_nm.push_back(rounded(std::cos(2 * pi * t) + 0.02 * normal(random), 1e-3));
  }
  record.torque_driver_nm.assign(record.size(), 0.0);
  return record;
}

void freeze(std::vector<double>& x, std::size_t from, std::size_t to) {
  for (std::size_t i = from + 1; i < to; ++i) x[i] = x[from];
}

TEST(FrozenChannels, ASensorWithNoiseThatRepeatsItsReadingIsLeftOut) {
  constexpr double kByChance_s = 0.025;  // the next reading, or the one before, may be the same as well
  Record record = turning(3e-4, 1e-4, false);
  freeze(record.angle_rad, 500, 700);
  freeze(record.torque_motor_nm, 650, 750);
  freeze(record.torque_motor_nm, 2820, 3000);
  const FrozenChannels frozen = leave_out_frozen(record);
  EXPECT_NEAR(frozen.length_s[static_cast<std::size_t>(Channel::kAngle)], 1.99, kByChance_s);
  EXPECT_NEAR(frozen.length_s[static_cast<std::size_t>(Channel::kTorqueMotor)], 0.99 + 1.79, kByChance_s);
  EXPECT_NEAR(static_cast<double>(record.size()), 3000 - 249 - 179, 4);
  EXPECT_EQ(record.angle_rad.size(), record.size());
  EXPECT_EQ(record.torque_driver_nm.size(), record.size());
  EXPECT_LE(record.time_s[500], 5.0);  // the reading itself was measured
  EXPECT_NEAR(record.time_s[501], 7.5, kByChance_s);
  EXPECT_NE(frozen.note().find("torque_motor for 2.7"), std::string::npos) << frozen.note();
}

TEST(FrozenChannels, LessThanHalfASecondIsLostSamples) {
  Record record = turning(3e-4, 1e-4, false);
  freeze(record.angle_rad, 500, 548);
  EXPECT_TRUE(leave_out_frozen(record).note().empty());
  EXPECT_EQ(record.size(), 3000U);
}

// An encoder without noise, coarse or fine, and a wheel that rests.
TEST(FrozenChannels, AWheelThatRestsIsNone) {
  for (const double step : {1e-6, 1e-4, 2e-3}) {
    Record record = turning(0, step, true);
    EXPECT_TRUE(leave_out_frozen(record).note().empty()) << step;
  }
}

TEST(FrozenChannels, ATorqueThatIsCommandedAndHeldIsNone) {
  Record record = turning(3e-4, 1e-4, false);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double t = record.time_s[i];
    record.torque_motor_nm[i] = t < 10 ? rounded(std::sin(2 * pi * 3 * t), 1e-6) : (t < 20 ? 0.5 : -0.5 * t);
  }
  EXPECT_TRUE(leave_out_frozen(record).note().empty());
}

TEST(FrozenChannels, ALimitIsNone) {
  Record record = turning(3e-4, 1e-4, false);
  for (double& torque : record.torque_motor_nm) torque = std::min(torque, -0.6);
  EXPECT_TRUE(leave_out_frozen(record).note().empty());
}

// An assist with a dead band follows a noisy bar and stands at zero within it.
TEST(FrozenChannels, ATorqueThatIsSwitchedOffIsNone) {
  Record record = turning(3e-4, 1e-4, false);
  std::fill(record.torque_motor_nm.begin() + 500, record.torque_motor_nm.begin() + 800, 0.0);
  EXPECT_TRUE(leave_out_frozen(record).note().empty());
}

TEST(FrozenChannels, AMotorIsNotLookedAtWhereTheBarIsUsed) {
  Record record = turning(3e-4, 1e-4, false);
  freeze(record.torque_motor_nm, 500, 800);
  Record by_bar = record;
  by_bar.torque_bar_nm.assign(record.size(), 0.0);
  by_bar.channels = kAngleValid | kTorqueBarValid | kTorqueMotorValid;
  EXPECT_TRUE(leave_out_frozen(by_bar).note().empty());
  EXPECT_FALSE(leave_out_frozen(record).note().empty());
}

}  // namespace
}  // namespace steerid::test
