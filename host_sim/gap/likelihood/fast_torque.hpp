// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The driver's own torque above 1 Hz, which no sensor sees and no effect explains: noise of every hypothesis.
//
//   tail     of his slow torque (gap/likelihood/noise_floor.hpp), whose colours end at some 1 Hz. His does not: it
//            falls behind two poles,   v 2 (f0 + f1)/(pi f0 f1) / ((1 + (f/f0)^2) (1 + (f/f1)^2))   beyond that end
//   tremor   of a held arm, a resonance at fm of damping z,   v 4 z/(pi fm) r^2 / ((1 - r^2)^2 + (2 z r)^2),
//            r = f/fm; v is its mean square
//
// Both are read once off a record, from what its likeliest set of changes leaves, and are the same for all sets from
// then on: a hypothesis that chose them for itself would take for a tremor whatever it misses.
#pragma once

#include <Eigen/Core>

namespace steerid::gap {

inline constexpr double kSecondOrderEnd_hz = 1.3;  ///< where a slow torque of second order ends

/// What is beyond that end over what is before it, at one frequency or at an array of them.
template <class F>
[[nodiscard]] F beyond_the_end(const F& f_hz) {
  const F x = f_hz / kSecondOrderEnd_hz;
  return x * x * x * x * x * x;
}

struct FastTorque {
  double tail_variance = 0;  ///< of the slow torque whose tail it is, Nm^2; 0: it has none
  double tail_corner_hz = 0.4;
  double tail_second_hz = 0.4;  ///< its other pole
  double tremor_variance = 0;   ///< Nm^2; 0: there is none
  double tremor_hz = 9;
  double tremor_damping = 0.1;

  [[nodiscard]] bool any() const { return tail_variance > 0 || tremor_variance > 0; }
  /// Nm^2/Hz; one value a frequency.
  [[nodiscard]] Eigen::ArrayXd density(const Eigen::ArrayXd& f_hz) const;
  /// Mean square of the tail's derivative, (Nm/s)^2.
  [[nodiscard]] double rate_variance() const;
};

}  // namespace steerid::gap
