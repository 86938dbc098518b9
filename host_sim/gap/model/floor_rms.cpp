// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/floor_rms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/likelihood/band_mean.hpp"

namespace steerid::gap {

std::function<double(double)> held_gain(WheelArm wheel) {
  wheel.stiffness_nm_per_rad = std::max(wheel.stiffness_nm_per_rad, 0.5 * wheel.inertia_kgm2);
  return [wheel](double w) { return std::norm(wheel_response(wheel, w)); };
}

std::function<double(double)> gain_with(const WheelArm& wheel, const std::vector<Effect>& effects) {
  if (!(wheel.stiffness_nm_per_rad > 0)) return held_gain(wheel);
  std::vector<std::pair<const Hypothesis*, std::vector<double>>> shaping;
  for (const Effect& effect : effects) {
    const Hypothesis* hypothesis = hypothesis_of(*effect.type);
    if (hypothesis != nullptr && !hypothesis->acts()) shaping.emplace_back(hypothesis, effect.values);
  }
  return [wheel, shaping](double w) {
    const Complex plain = wheel_response(wheel, w);
    Complex response = plain;
    for (const auto& [hypothesis, values] : shaping) {
      response *= hypothesis->response(wheel, values.data(), w) / plain;
    }
    return std::norm(response);
  };
}

double floor_rms_rad(const NoiseFloor& floor, const std::function<double(double)>& gain, double quantum_rad) {
  const double moved = band_mean(0, kResampledRateHz / 2, [&](double f_hz) {
    return floor.holds(f_hz) ? gain(2 * std::numbers::pi * f_hz) * floor.torque_density(f_hz) : 0;
  });
  // A rounded angle hides its noise; what the simulation misses makes it round the other way now and then.
  if (quantum_rad > 0) return std::sqrt(quantum_rad * std::sqrt(moved) * std::sqrt(2 / std::numbers::pi));
  return std::sqrt(floor.angle_variance + moved);
}

}  // namespace steerid::gap
