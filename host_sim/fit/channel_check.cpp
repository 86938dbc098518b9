// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/channel_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steerid {
namespace {

// A steering wheel alone, with room on either side of the 0.026 to 0.043 kg m2 and 0.03 to 0.08 Nms/rad of passenger
// cars; the smallest arm on one is several times as damped (docs/units_and_limits.md).
constexpr double kHeaviestWheelKgm2 = 0.12;
constexpr double kMostWheelDamping = 0.5;
constexpr double kLikeOneAnother = 0.8;    // correlation of rim and bar
constexpr double kAnswerEachOther = 0.15;  // of bar and motor, which dead zone and probe keep apart
constexpr double kMostly = 0.7;            // share of the power that an arm's motion must explain
constexpr double kHalf = 0.5;              // and a column's, whose friction it does not
constexpr double kAPart = 0.1;             // what a light wheel explains of the difference of two noisy sensors
constexpr double kNoSpring = 0.1;          // share of the torque that a wheel without a spring may seem to need for one

double rms_about_mean(const std::vector<double>& x) {
  double sum = 0, squares = 0;
  for (const double value : x) sum += value, squares += value * value;
  const auto n = static_cast<double>(std::max<std::size_t>(x.size(), 1));
  return std::sqrt(std::max(0.0, squares / n - sum * sum / n / n));
}

/// The torque between two sensors is that of a wheel alone, in size and in kind.
bool wheel_alone(const Record& record, const MotionFit& fit, double sensor_rms_nm) {
  const double inertia = std::abs(fit.inertia.value);
  return fit.inertia.shown() && inertia < kHeaviestWheelKgm2 && std::abs(fit.damping.value) < kMostWheelDamping &&
         std::abs(fit.stiffness.value) * rms_about_mean(record.angle_rad) < kNoSpring * sensor_rms_nm;
}

std::vector<double> combined(const std::vector<double>& one, double times, const std::vector<double>& other) {
  std::vector<double> all(one.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = one[i] + times * other[i];
  return all;
}

bool physical(const MotionFit& fit) {
  return fit.inertia.shown() && fit.inertia.value > 0 && fit.damping.value > 0 && fit.stiffness.value > 0;
}

}  // namespace

WheelBetween wheel_between(const Record& record) {
  using Verdict = WheelBetween::Verdict;
  const std::vector<double>& rim = record.torque_rim_nm;
  const std::vector<double>& bar = record.torque_bar_nm;
  WheelBetween wheel{.fit = fit_motion(record, combined(rim, -1, bar)),
                     .gain = fit_motion(record, rim, false, bar).gain};
  const MotionFit& fit = wheel.fit;
  if (fit.samples == 0) return wheel;
  const bool same_size = std::abs(wheel.gain.value - 1) < WheelBetween::kGainTolerance + 4 * wheel.gain.sd;
  if (rim == bar) {
    wheel.verdict = Verdict::kSame;
  } else if (wheel.gain.shown() && wheel.gain.value < 0) {
    wheel.verdict = Verdict::kOpposed;
  } else if (!same_size || (fit.inertia.shown() && !wheel_alone(record, fit, rms_about_mean(rim)))) {
    wheel.verdict = Verdict::kDisagree;
  } else if (fit.inertia.shown()) {
    wheel.verdict = fit.inertia.value < 0 ? Verdict::kSwapped : Verdict::kAgree;
  }
  return wheel;
}

TorquePair torque_pair(const Record& record) {
  using Verdict = TorquePair::Verdict;
  const std::vector<double>& driver = record.torque_driver_nm;
  const std::vector<double>& motor = record.torque_motor_nm;
  const MotionFit as_named = fit_motion(record, combined(driver, -1, motor));
  const double alike = smoothed_correlation(record, driver, motor);
  if (alike > kLikeOneAnother && as_named.explained > kAPart && wheel_alone(record, as_named, rms_about_mean(driver))) {
    return {as_named.inertia.value > 0 ? Verdict::kRimAndBar : Verdict::kBarAndRim, as_named};
  }
  if (physical(as_named) && as_named.explained > kMostly) return {};
  const MotionFit reaction = fit_motion(record, combined(driver, -2, driver));
  if (physical(reaction) && reaction.explained > kMostly) return {Verdict::kReaction, reaction};
  const MotionFit column = fit_motion(record, combined(driver, 1, motor));
  if (std::abs(alike) > kAnswerEachOther && physical(column) && column.explained > kHalf) {
    return {Verdict::kBarAndMotor, column};
  }
  return {};
}

}  // namespace steerid
