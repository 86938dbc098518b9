// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the torque sensor's noise pretends to know.
//
// The instrument is the model's answer to the measured torque. The sensor's noise n is in that torque but never moved
// the wheel: it drives the model all the same, adds information that is not there, and, standing on both sides of the
// equation, pulls the estimate towards the model. Against a probe it is one part in ten thousand; on a straight road
// it is all there is. It can be worked out: behind F = a0/(s^2 + a1 s + a0) and the wheel 1/(J s^2 + B s + C) white
// noise of variance s2 at the period T has
//
//   E[th^2]   = s2 T (a0/J)^2 (c2 c3 - c1)/(2 c0 D)
//   E[th'^2]  = s2 T (a0/J)^2 c3/(2 D)                  E[th th''] = -E[th'^2],   E[th th'] = E[th' th''] = 0
//   E[th''^2] = s2 T (a0/J)^2 c1/(2 D)                  D = c1 c2 c3 - c1^2 - c0 c3^2
//
// with s^4 + c3 s^3 + c2 s^2 + c1 s + c0 the product of both denominators (the standard integrals of order four;
// Newton, Gould and Kaiser 1957, appendix E).
#pragma once

#include "identifier/noise_colour.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

/// The instrument's power that is made of noise, each per sample.
template <class Scalar>
struct NoiseInformation {
  Scalar angle{0};         ///< E[th^2]
  Scalar rate{0};          ///< E[th'^2]
  Scalar acceleration{0};  ///< E[th''^2]

  /// What is left of E[th''^2] once th is known.
  [[nodiscard]] Scalar acceleration_alone() const {
    return angle > Scalar(0) ? acceleration - rate * rate / angle : acceleration;
  }
};

/// Of the regressor that is made of the measured angle, behind F with corner a0 and rate a1: the angle sensor's noise,
/// E[th^2] = s2 T a0/(2 a1), E[th'^2] = s2 T a0^2/(2 a1). What F lets through of it at high frequencies makes
/// th'' = a0 (n - th) - a1 th', at most a0^2 s2.
template <class Scalar>
NoiseInformation<Scalar> angle_noise_information(Scalar a0, Scalar a1, Scalar angle_variance, Scalar period_s) {
  const Scalar power = angle_variance * period_s * a0 / (Scalar(2) * a1);
  return {power, power * a0, a0 * a0 * angle_variance};
}

/// For the parameters p behind F with corner a0 in 1/s2 and rate a1 in 1/s, and behind the whitening filter. What the
/// whitening filter leaves is told at one frequency each, where its power lies without the whitening filter: the
/// angle's below the wheel's own frequency, the rate's at it or, where damping makes it broad, above, the
/// acceleration's towards F's corner. Above the wheel's frequency the angle falls with w^-2, and the whitening filter
/// rises with it: what lies between there and the whitening filter's end or F's corner is added to angle and rate.
/// Within a factor of 3.5 of the integral for five arms from relaxed to braced, F from 2.5 to 6 Hz and depths to 0.93.
template <class Scalar>
[[gnu::noinline]] NoiseInformation<Scalar> noise_information(const Vector3<Scalar>& p, Scalar a0, Scalar a1,
                                                             Scalar torque_variance, Scalar period_s,
                                                             const WhiteningShape<Scalar>& whitening) {
  const Scalar b0 = p(kStiffness) / p(kInertia);
  const Scalar b1 = p(kDamping) / p(kInertia);
  const Scalar c3 = a1 + b1;
  const Scalar c2 = a0 + b0 + a1 * b1;
  const Scalar c1 = a1 * b0 + a0 * b1;
  const Scalar c0 = a0 * b0;
  const Scalar gain = a0 / p(kInertia);
  const Scalar power = torque_variance * period_s * gain * gain / (Scalar(2) * (c1 * (c2 * c3 - c1) - c0 * c3 * c3));
  const Scalar edge = b0 + Scalar(0.3) * b1 * b1;
  const Scalar end = whitening.end(period_s);
  const Scalar above = Scalar(0.3) * b1 * end / (end * end + edge) * (a0 / (a0 + end * end));
  const auto with = [](Scalar left, Scalar more) {
    return more < Scalar(1) ? left + (Scalar(1) - left) * more : Scalar(1);
  };
  return {
      power * (c2 * c3 - c1) / c0 * with(whitening.power_left(Scalar(0.5) * b0, period_s), above * b0 / (end * end)),
      power * c3 * with(whitening.power_left(edge, period_s), above),
      power * c1 * whitening.power_left(Scalar(0.7) * a0 + Scalar(0.5) * edge, period_s)};
}

}  // namespace steerid
