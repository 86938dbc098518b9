// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The common filter F: the low-pass that both sides of the equation of motion pass, chosen so that what is left of it
// is white.
//
// With white noise s_u on the torque and s_th on the angle, the equation's error J th'' + B th' + C th - T has the
// spectrum s_u^2 + s_th^2 |J s^2 + B s + C|^2. Its spectral factor is again second order, s_th (J s^2 + B' s + C')
// with
//
//   C' = sqrt(C^2 + rho^2),   B' = sqrt(B^2 + 2 J (C' - C)),   rho = s_u / s_th   [Nm/rad]
//
// (equate coefficients of 1, w^2 and w^4). Behind F = C' / (J s^2 + B' s + C') the error is therefore white: least
// squares on it is weighted as it should be at every frequency. With a perfect torque sensor F is 1/(J s^2 + B s + C)
// and the method is output error; with a perfect angle sensor it is equation error. This is Young's refined
// instrumental variable with the noise model made of what the sensors say (Young 2011, Recursive Estimation and
// Time-Series Analysis, chapter 8).
#pragma once

#include "base/square_root.hpp"
#include "identifier/parameters.hpp"
#include "identifier/second_order_filter.hpp"

namespace steerid {

/// F = corner / (s^2 + rate s + corner).
template <class Scalar>
struct CommonFilter {
  Scalar corner{0};  ///< 1/s2
  Scalar rate{0};    ///< 1/s

  [[nodiscard]] SecondOrderCoefficients<Scalar> at(Scalar period_s) const {
    return second_order_coefficients(corner, rate, period_s);
  }
  /// Of which these are the coefficients.
  static CommonFilter of(const SecondOrderCoefficients<Scalar>& c, Scalar period_s) {
    const Scalar by = Scalar(1) / (c.rate_keep * period_s);
    return {c.stiffness_step * by, (Scalar(1) - c.rate_keep) * by};
  }
  /// Samples until a disturbance of the filter has died away to a thousandth, exp(-6.9).
  [[nodiscard]] int ring_out(Scalar period_s) const {
    const Scalar slow = Scalar(2) * corner < rate * rate ? corner / rate : rate * Scalar(0.5);
    return static_cast<int>(Scalar(6.9) / (slow * period_s));
  }
  /// Neither is off by more than `factor`.
  [[nodiscard]] bool near(const CommonFilter& other, Scalar factor) const {
    const auto close = [factor](Scalar a, Scalar b) { return a < factor * b && b < factor * a; };
    return close(corner, other.corner) && close(rate, other.rate);
  }
};

/// F for the parameters p and rho_squared = (s_u / s_th)^2 in (Nm/rad)^2.
/// The corner is held between 1.6 and 11 Hz: below lies nothing but the wheel, above nothing but noise.
template <class Scalar>
CommonFilter<Scalar> common_filter(const Vector3<Scalar>& p, Scalar rho_squared) {
  constexpr double kSlowest = 100.0;   ///< (1.6 Hz)^2 in 1/s2
  constexpr double kFastest = 4900.0;  ///< (11 Hz)^2
  const Scalar inertia = p(kInertia);
  const Scalar damping = p(kDamping) / inertia;
  const Scalar wheel = p(kStiffness) / inertia;
  Scalar corner = square_root(p(kStiffness) * p(kStiffness) + rho_squared) / inertia;
  if (corner < Scalar(kSlowest)) corner = Scalar(kSlowest);
  if (corner > Scalar(kFastest)) corner = Scalar(kFastest);
  Scalar rate_squared = damping * damping + Scalar(2) * (corner - wheel);
  // A wheel faster than the fastest corner would ask for no damping at all; keep F's own ringing short.
  if (rate_squared < corner) rate_squared = corner;
  return {corner, square_root(rate_squared)};
}

}  // namespace steerid
