// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction of the wheel above the torsion bar: of its bearing, seal and slip ring.
//
//   torque = F s,   s = (th(k) - th(k - 4)) / 2 mrad, within +-1: the friction two ticks before
//
// Below 0.05 rad/s the wheel may as well stick, and friction then bears any torque up to F: of a wheel that nobody
// holds the torque that is on it, of one with hands nobody knows which, in the middle none. The difference over four
// ticks is no later than the torque that it is taken off. With 0.02 rad/s B comes out a little better (within a tenth
// on 90 % of the ticks, 87 % with 0.05, 66 % with 0.1), but the noise of an angle of 0.7 mrad then passes for motion,
// and an empty wheel with 0.1 Nm is told on half as many ticks (docs/adr/0029).
//
// F is known to 8 %: what a record of the wheel says, 2 to 12 % too large. What it is off by, d, is taken for a damping
// of d E|w| / E w^2 of a motion at the rate w, by its work; E|w| = sqrt(2 E w^2 / pi) where that is normal. Without
// this B of the held-out column is valid and wrong on 5, 11 and 20 % of its valid ticks beside 0.1, 0.2 and 0.3 Nm,
// with it on 2.4, 1.4 and 2.4; with 5 and 15 % on 3.4, 4.6, 6.7 and on 0.5, 0, 0, where next to nothing is valid any
// more.
//
// Units: Nm, rad; torque against the motion, F from 0 on. Cost: 1 product each.
#pragma once

#include <numbers>

namespace steerid {

template <class Scalar>
struct WheelFriction {
  static constexpr int kTicks = 4;          ///< from the first to the last angle
  static constexpr double kSlides = 2e-3;   ///< rad within them: 0.05 rad/s
  static constexpr double kKnownTo = 0.08;  ///< of F, one standard deviation

  /// s, by how far the wheel has turned within kTicks.
  [[nodiscard]] static Scalar share(Scalar turned_rad) { return within(turned_rad * Scalar(1 / kSlides), Scalar(1)); }
  /// What friction bears of the torque on a wheel without hands that turns with `share`: none of it where it slides.
  [[nodiscard]] static Scalar borne(Scalar torque_nm, Scalar friction_nm, Scalar share) {
    const Scalar sticks = Scalar(1) - (share < Scalar(0) ? Scalar(0) - share : share);
    return sticks * within(torque_nm, friction_nm);
  }
  /// Variance of B, (Nms/rad)^2, for want of knowing F better, where the rate has the mean square `rate_power`,
  /// rad2/s2.
  [[nodiscard]] static Scalar damping_variance(Scalar friction_nm, Scalar rate_power) {
    return friction_nm * friction_nm * Scalar(kKnownTo * kKnownTo * 2 / std::numbers::pi) /
           (rate_power + Scalar(kLeastPower));
  }

 private:
  static constexpr double kLeastPower = 1e-6;  ///< rad2/s2: a wheel at rest
  static Scalar within(Scalar x, Scalar most) { return x > most ? most : x < Scalar(0) - most ? Scalar(0) - most : x; }
};

}  // namespace steerid
