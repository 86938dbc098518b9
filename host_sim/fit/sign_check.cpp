// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/sign_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fit/gauss_newton.hpp"

namespace steerid {
namespace {

constexpr double kFarBetter = 4;     // in power
constexpr double kExplained = 1e-3;  // of the power left: a turned channel that leaves so little moves the wheel by 2 %

struct Signs {
  bool torque_driver;
  bool torque_motor;
};

bool varies(const std::vector<double>& channel) {
  const auto other = [&channel](double value) { return std::isfinite(value) && value != channel.front(); };
  return std::any_of(channel.begin(), channel.end(), other);
}

void turn(std::vector<double>& channel) {
  for (double& value : channel) value = -value;
}

/// Share of the angle's power that the fit leaves, over the samples that it used.
double unexplained(const BatchFit& fit) {
  double samples = 0, sum = 0, squares = 0, left = 0;
  for (std::size_t i = 0; i < fit.residual_rad.size(); ++i) {
    if (!std::isfinite(fit.residual_rad[i])) continue;
    const double angle = fit.angle_model_rad[i] + fit.residual_rad[i];
    samples += 1;
    sum += angle;
    squares += angle * angle;
    left += fit.residual_rad[i] * fit.residual_rad[i];
  }
  const double power = squares - sum * sum / std::max(samples, 1.0);
  return power > 0 ? left / power : 1;
}

bool physical(const BatchFit& fit) {
  const auto sure = [](const FittedParameter& p) { return p.state == ParameterState::kValid; };
  return !fit.damping.model_misfit && !fit.stiffness.model_misfit && (sure(fit.damping) || sure(fit.stiffness));
}

BatchFit white_fit(Record record, const Signs& turned, bool torque_offset) {
  if (turned.torque_driver) turn(record.torque_driver_nm);
  if (turned.torque_motor) turn(record.torque_motor_nm);
  FitOptions options;
  options.noise = FitOptions::Noise::kWhite;
  options.torque_offset = torque_offset;
  options.convergence_factor = false;
  options.max_iterations = 20;  // a record with the right signs takes fewer; one without may wander for long
  return fit_batch(record, options);
}

}  // namespace

SignCheck check_signs(const Record& record, bool torque_offset) {
  SignCheck check;
  const BatchFit as_it_stands = white_fit(record, {}, torque_offset);
  if (as_it_stands.stop == StopReason::kNoData) return check;
  check.unexplained = unexplained(as_it_stands);
  if (check.unexplained < kExplained) return check;
  const bool driver = varies(record.torque_driver_nm);
  const bool motor = varies(record.torque_motor_nm);
  std::vector<Signs> others;
  if (driver) others.push_back({true, false});
  if (motor) others.push_back({false, true});
  if (driver && motor) others.push_back({true, true});

  double least = check.unexplained / kFarBetter;
  for (const Signs& turned : others) {
    const BatchFit fit = white_fit(record, turned, torque_offset);
    const double left = unexplained(fit);
    if (!physical(fit) || left >= least) continue;
    least = left;
    check.torque_driver = turned.torque_driver;
    check.torque_motor = turned.torque_motor;
    check.unexplained_turned = left;
  }
  return check;
}

}  // namespace steerid
