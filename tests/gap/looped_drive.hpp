// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel that a position loop holds, with a known answer, that shares no code with the plant: a bar of inertia and dry
// friction, no spring, that is taken along a multisine at 1 kHz in steps of 0.1 ms,
//   T = K (reference - measured) + D d/dt(...), 5 ms late
// The torque itself is recorded: it holds for a millisecond, so that at the instant of the angle it is the mean of two.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <numbers>
#include <vector>

#include "gap/drawn_drive.hpp"
#include "log/record.hpp"
#include "plant/simulation.hpp"

namespace steerid::test {

struct PositionLoop {
  double inertia_kgm2 = 0.043;
  double damping_nms_per_rad = 0.08;
  double friction_nm = 0.085;
  double angle_noise_rad = 6e-5;
  double highest_hz = 4.8;  ///< of the reference
  /// What else pushes, of angle and rate; asked ten times a millisecond.
  std::function<double(double, double)> torque = [](double, double) { return 0.0; };
  double duration_s = 30;
  std::size_t angle_late_ms = 0;  ///< of its record alone
  /// When a hand is away: with it all that pushes goes, half of the inertia and all but a twentieth of the damping.
  std::function<bool(double)> away = [](double) { return false; };
};

inline Record looped(const PositionLoop& what, std::uint64_t seed) {
  constexpr double kStiff_nm_per_rad = 80;
  constexpr double kDamp_nms_per_rad = 2.5;
  constexpr double kLowPass_s = 0.003;  // of the rate
  constexpr std::size_t kLate = 5;
  constexpr int kSteps = 10;  // of 0.1 ms
  constexpr double kStep_s = 1e-4;
  Noise noise(seed);
  std::vector<double> phase;
  for (double f = 0.2; f <= what.highest_hz + 1e-9; f += 0.2) phase.push_back(2 * std::numbers::pi * noise.uniform());
  const auto reference = [&](double t) {
    double sum = 0;
    for (std::size_t k = 0; k < phase.size(); ++k) {
      const double f = 0.2 * static_cast<double>(k + 1);
      sum += 0.04 / (1 + f * f) * std::cos(2 * std::numbers::pi * f * t + phase[k]);
    }
    return sum;
  };
  Record record;
  std::deque<double> commands(kLate, 0.0);
  std::deque<double> late;
  double angle = 0;
  double rate = 0;
  double error_before = 0;
  double error_rate = 0;
  double torque = 0;
  for (int i = 0; i < static_cast<int>(1000 * what.duration_s); ++i) {
    const double t = 0.001 * i;
    const double measured = angle + what.angle_noise_rad * noise();
    const double error = reference(t) - measured;
    error_rate += (1000 * (error - error_before) - error_rate) * -std::expm1(-0.001 / kLowPass_s);
    error_before = error;
    commands.push_back(kStiff_nm_per_rad * error + kDamp_nms_per_rad * error_rate);
    const double before = torque;
    torque = commands.front();
    commands.pop_front();
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back((before + torque) / 2);
    record.torque_motor_nm.push_back(0);
    late.push_back(measured);
    record.angle_rad.push_back(late.front());
    if (late.size() > what.angle_late_ms) late.pop_front();
    const bool away = what.away(t);
    const double inertia_kgm2 = (away ? 0.5 : 1) * what.inertia_kgm2;
    const double damping_nms_per_rad = (away ? 0.05 : 1) * what.damping_nms_per_rad;
    const double hold = kStep_s * what.friction_nm / inertia_kgm2;
    for (int step = 0; step < kSteps; ++step) {
      const double push = torque + (away ? 0 : what.torque(angle, rate)) - damping_nms_per_rad * rate;
      const double next = rate + kStep_s * push / inertia_kgm2;
      const double slid = std::abs(next) <= hold ? 0 : next - std::copysign(hold, next);
      angle += kStep_s / 2 * (rate + slid);
      rate = slid;
    }
  }
  return record;
}

/// The simulation of such a bar, off as simulations are.
inline Simulation off(const PositionLoop& what, double stiffness_nm_per_rad) {
  Simulation simulation;
  simulation.wheel = {1.05 * what.inertia_kgm2, 1.06 * what.damping_nms_per_rad, 0.94 * stiffness_nm_per_rad};
  return simulation;
}

}  // namespace steerid::test
