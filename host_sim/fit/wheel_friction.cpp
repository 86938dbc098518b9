// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/wheel_friction.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "fit/channel_check.hpp"
#include "fit/instrumented_rows.hpp"
#include "identifier/wheel_friction.hpp"
#include "log/record_quality.hpp"
#include "log/resample.hpp"

namespace steerid {
namespace {

constexpr int kMostRounds = 10;
constexpr double kStands = 0.1;  // deviations by which the last round may move F

/// s of every sample; beside a gap that of the nearest sample with angles to either side.
std::vector<double> sliding(const Record& record) {
  constexpr std::size_t kReach = WheelFriction<double>::kTicks / 2;
  std::vector<double> all(record.size(), 0.0);
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    if (rows.size() <= 2 * kReach) continue;
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      const std::size_t at = std::clamp(i, rows.begin + kReach, rows.end - kReach - 1);
      all[i] = WheelFriction<double>::share(record.angle_rad[at + kReach] - record.angle_rad[at - kReach]);
    }
  }
  return all;
}

/// s by the rate behind the Gaussian of fit_motion(): the angle's noise would flatten it, and a damping below zero
/// would make up for that.
std::vector<double> sliding_smoothly(const Record& record) {
  constexpr double kTurned_s = WheelFriction<double>::kTicks / kResampledRateHz;
  std::vector<double> all = smoothed_rate_rad_s(record);
  for (double& s : all) s = WheelFriction<double>::share(s * kTurned_s);
  return all;
}

/// s of a wheel that nobody holds, with a friction of `friction_nm` and a sensor that is off by `constant_nm`.
std::vector<double> sliding_or_held(const Record& record, double friction_nm, double constant_nm) {
  std::vector<double> all = sliding(record);
  if (!(friction_nm > 0)) return all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double held = std::clamp((record.net_torque_nm(i) - constant_nm) / friction_nm, -1.0, 1.0);
    all[i] += (1 - std::abs(all[i])) * held;
  }
  return all;
}

Record less(Record record, double friction_nm, const std::vector<double>& s) {
  for (std::size_t i = 0; i < record.size(); ++i) record.torque_bar_nm[i] += friction_nm * s[i];
  return record;
}

/// The record of a wheel whose bar reads nothing but a friction of 1 Nm.
Record friction_alone(Record record, const std::vector<double>& s) {
  std::ranges::transform(s, record.torque_bar_nm.begin(), std::negate<>());
  return record;
}

/// What J, B, C and a constant leave of a whitened torque, by the instrument.
Eigen::VectorXd left_of(const Eigen::VectorXd& torque, const InstrumentedRows::White& white) {
  const Eigen::Matrix4d both = white.instrument.transpose() * white.motion;
  return torque - white.motion * both.fullPivLu().solve(white.instrument.transpose() * torque);
}

}  // namespace

Record less_wheel_friction(const Record& record, double friction_nm) {
  if (record.equation() != Equation::kBar || !(friction_nm > 0)) return record;
  return less(record, friction_nm, sliding(record));
}

std::optional<FittedNumber> friction_between_sensors(const Record& record) {
  if (record.equation() != Equation::kBar || !record.has(kTorqueRimValid)) return std::nullopt;
  const FittedNumber friction = fit_motion(record, explained_torque_nm(record), true, sliding_smoothly(record)).gain;
  const bool shown = friction.shown() && friction.value > 0;
  if (!shown || wheel_between(less(record, friction.value, sliding(record))).verdict != WheelBetween::Verdict::kAgree) {
    return std::nullopt;
  }
  return friction;
}

std::optional<BareWheelFit> fit_bare_wheel(const Record& record) {
  if (record.equation() != Equation::kBar) return std::nullopt;
  const InstrumentedRows rows(record);
  const auto n = static_cast<double>(rows.size());
  BareWheelFit found{{0, 0}, fit_by_instrument(rows)};
  InstrumentalFit& wheel = found.wheel;
  if (wheel.stiffness.value - 2 * wheel.stiffness.sd > kEmptyWheel) return std::nullopt;
  FittedNumber& friction = found.friction;
  double nats = 0;
  double moved = 1;
  for (int round = 0; round < kMostRounds && moved > kStands * friction.sd && wheel.rows > 0; ++round) {
    const std::vector<double> s = sliding_or_held(record, friction.value, wheel.constant_nm);
    const InstrumentedRows::White white = rows.whitened(wheel.noise);
    const Eigen::VectorXd torque = left_of(white.torque, white);
    const Eigen::VectorXd one =
        left_of(InstrumentedRows(friction_alone(record, s)).whitened(wheel.noise).torque, white);
    const double before = friction.value;
    friction.value = one.dot(torque) / one.squaredNorm();
    const double left = (torque - friction.value * one).squaredNorm();
    friction.sd = std::sqrt(left / n / one.squaredNorm());
    nats = n / 2 * std::log(torque.squaredNorm() / left) - std::log(n) / 2;
    moved = std::abs(friction.value - before);
    wheel = fit_by_instrument(less(record, friction.value, s));
  }
  if (wheel.inertia.state != ParameterState::kValid) return std::nullopt;
  const bool empty = wheel.rows > 0 && wheel.stiffness.value + 2 * wheel.stiffness.sd < kEmptyWheel;
  if (!(friction.value > 0) || !(nats > 0) || !empty) return std::nullopt;
  return found;
}

}  // namespace steerid
