// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the hand feels of a probe: the torque on the rim that one newton metre of the motor makes, in closed form.
//
//   G(s) = kb / (a (c + kb (1 + g)) + kb c),   a = J s^2 + B s + C,  c = Jc s^2 + Bc s + Cr,  kb = kt + bt s
//   felt = |(J - Jw) s^2 + (B - Bw) s + C| |G|
//
// J, B, C are arm and wheel above the bar; g is the assist's gain (column.hpp). Friction, of wheel and rack, and the
// assist's dead zone are left out: friction takes some of a small probe away, the dead zone gives some back. The lines
// of a probe are independent: its rms at the rim is the root of the sum of their squares.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>

#include "plant/column.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

/// Nm at the rim a Nm of probe at `hz`.
[[nodiscard]] inline double felt_at_rim(const Column& column, const WheelArm& arm, double hz) {
  const std::complex<double> s(0, 2 * std::numbers::pi * hz);
  const std::complex<double> above = (arm.inertia_kgm2 * s + arm.damping_nms_per_rad) * s + arm.stiffness_nm_per_rad;
  const std::complex<double> below =
      (column.column_inertia_kgm2 * s + column.column_damping_nms_per_rad) * s + column.aligning_stiffness_nm_per_rad;
  const std::complex<double> bar = column.bar_stiffness_nm_per_rad + column.bar_damping_nms_per_rad * s;
  const std::complex<double> angle = bar / (above * (below + bar * (1 + column.assist_gain)) + bar * below);
  const std::complex<double> hand = above - (column.wheel_inertia_kgm2 * s + column.wheel_damping_nms_per_rad) * s;
  return std::abs(hand * angle);
}

/// Root mean square at the rim of one of `rms_nm` with equal lines between two frequencies, 0.1 Hz apart, Nm.
[[nodiscard]] inline double felt_of_flat_probe(const Column& column, const WheelArm& arm, double rms_nm, double low_hz,
                                               double high_hz) {
  double square = 0;
  int lines = 0;
  for (double hz = low_hz; hz < high_hz + 0.05; hz += 0.1, ++lines) {
    const double felt = felt_at_rim(column, arm, hz);
    square += felt * felt;
  }
  return rms_nm * std::sqrt(square / lines);
}

}  // namespace steerid
