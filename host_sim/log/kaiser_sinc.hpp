// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Kaiser's window by his own formulas, and the sinc under it that is a low pass of linear phase.
//
// J. F. Kaiser, "Nonrecursive digital filter design using the I0-sinh window function", IEEE ISCAS 1974. Attenuations
// are those of the stop band, above 50 dB.
#pragma once

#include <cmath>
#include <numbers>

namespace steerid {

/// The window's shape.
constexpr double kaiser_beta(double attenuation_db) { return 0.1102 * (attenuation_db - 8.7); }

/// Half of the length of a filter that falls from its pass band to its stop band within `transition_hz`.
constexpr double kaiser_half_length_s(double attenuation_db, double transition_hz) {
  return (attenuation_db - 7.95) / (2 * 2.285 * 2 * std::numbers::pi * transition_hz);
}

/// At `share`, -1 to 1, of the half length from the centre, where it is 1.
inline double kaiser_window(double beta, double share) {
  return std::cyl_bessel_i(0.0, beta * std::sqrt(1 - share * share)) / std::cyl_bessel_i(0.0, beta);
}

/// sin(angle) / angle.
inline double sinc(double angle_rad) { return angle_rad == 0 ? 1.0 : std::sin(angle_rad) / angle_rad; }

}  // namespace steerid
