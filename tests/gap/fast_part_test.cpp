// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What of a signal is faster than a frequency, against sinusoids in closed form.
#include "gap/likelihood/fast_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace steerid::gap {
namespace {

constexpr double kRate_hz = 100;
constexpr double kFrom_hz = 2;
constexpr std::size_t kReach = 400;  // rows that the filter reaches, and some

std::vector<double> sinusoid(double f_hz) {
  std::vector<double> out(3000);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = std::sin(2 * std::numbers::pi * f_hz * static_cast<double>(i) / kRate_hz);
  }
  return out;
}

/// The largest difference from `expected` times the signal, its ends aside.
double off(const std::vector<double>& signal, const std::vector<double>& filtered, double expected) {
  double most = 0;
  for (std::size_t i = kReach; i + kReach < signal.size(); ++i) {
    most = std::max(most, std::abs(filtered[i] - expected * signal[i]));
  }
  return most;
}

TEST(FastPart, KeepsWhatIsFasterWithItsPhaseAndTakesOffWhatIsSlower) {
  for (const double f_hz : {2.0, 2.5, 7.0, 30.0}) {
    const std::vector<double> signal = sinusoid(f_hz);
    EXPECT_LT(off(signal, fast_part(signal, kFrom_hz), 1), 1.5e-3) << f_hz;
  }
  for (const double f_hz : {0.0, 0.1, 0.6, 1.5}) {
    const std::vector<double> signal = sinusoid(f_hz);
    EXPECT_LT(off(signal, fast_part(signal, kFrom_hz), 0), 1.5e-3) << f_hz;
  }
  const std::vector<double> between = sinusoid(kFrom_hz - kTransition_hz / 2);
  EXPECT_LT(off(between, fast_part(between, kFrom_hz), 0.5), 5e-3);
}

TEST(FastPart, OfAConstantAndARampNothingIsLeftUpToTheEnds) {
  std::vector<double> ramp(2000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = 3 + 0.01 * static_cast<double>(i);
  for (const double left : fast_part(ramp, kFrom_hz)) EXPECT_NEAR(left, 0, 1e-9);
}

/// What the filter lets pass below its edge once must not be filtered again where a model is compared with it.
TEST(FastPart, DriftIsTakenOffBelowWhatTheRecordHolds) {
  const std::vector<double> edge = sinusoid(kFrom_hz - kTransition_hz);
  EXPECT_LT(off(edge, without_drift(edge, kFrom_hz), 1), 1.5e-3);
  const std::vector<double> drift = sinusoid(kFrom_hz - 2 * kTransition_hz);
  EXPECT_LT(off(drift, without_drift(drift, kFrom_hz), 0), 1.5e-3);
}

TEST(FastPart, UnknownSamplesStayUnknownAndZeroKeepsEverything) {
  std::vector<double> signal = sinusoid(5);
  EXPECT_EQ(fast_part(signal, 0), signal);
  signal[1500] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> left = fast_part(signal, kFrom_hz);
  EXPECT_TRUE(std::isnan(left[1500]));
  EXPECT_TRUE(std::isfinite(left[1501]));
}

TEST(FastPart, OfARecordEveryStretchByItself) {
  Record record;
  const std::vector<double> tone = sinusoid(4);
  for (std::size_t i = 0; i < tone.size(); ++i) {
    record.time_s.push_back((i < 1500 ? 0 : 20) + static_cast<double>(i) / kRate_hz);
    record.angle_rad.push_back(tone[i] + (i < 1500 ? 0 : 9));
  }
  record.torque_driver_nm.assign(tone.size(), 0);
  record.torque_motor_nm = tone;
  const Record left = fast_part(record, kFrom_hz);
  for (std::size_t i = 1100; i < 1900; ++i) EXPECT_LT(std::abs(left.angle_rad[i]), 1.3) << i;  // the jump is no motion
  for (std::size_t i = kReach; i + kReach < 1500; ++i) {
    EXPECT_NEAR(left.torque_motor_nm[i], tone[i], 2e-3) << i;
    EXPECT_NEAR(left.torque_motor_nm[1500 + i], tone[1500 + i], 2e-3) << i;
  }
  EXPECT_EQ(left.time_s, record.time_s);
}

}  // namespace
}  // namespace steerid::gap
