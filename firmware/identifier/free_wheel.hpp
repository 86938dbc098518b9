// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel of known J, B and C that runs freely on a torque: the instrument where all torque is measured, since no noise
// of the angle's sensor is in its motion.
//
// Any wheel makes an instrument without bias; the one of now makes the best. While the parameters are still on their
// way it must not be one that hardly ever comes to rest: its motion would be large, and the data's none of it.
//
// Units: Nm, rad, s. Cost a sample: 4 products; a renewal 2 divisions.
#pragma once

#include "identifier/differentiator.hpp"
#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
class FreeWheel {
 public:
  static constexpr double kSlowestReturn = 1;  ///< 1/s, C/B of the slowest wheel that makes an instrument

  /// The least stiffness of a wheel with these parameters; one that takes its place is not the wheel's.
  [[nodiscard]] static Scalar softest(const Vector3<Scalar>& p) { return Scalar(kSlowestReturn) * p(kDamping); }

  /// From now on another wheel; it goes on from where it is.
  [[gnu::noinline]] void become(const Vector3<Scalar>& p, Scalar period_s) {
    const Scalar inertia = p(kInertia);
    const Scalar damping = p(kDamping);
    // The step is stable for C T^2 < 4 J; only the corner of the limits that no arm reaches lies beyond.
    const Scalar stiffest = Scalar(3) * inertia / (period_s * period_s);
    Scalar stiffness = p(kStiffness) > softest(p) ? p(kStiffness) : softest(p);
    if (stiffness > stiffest) stiffness = stiffest;
    const Scalar scale = Scalar(1) / (inertia + period_s * damping);
    rate_keep_ = inertia * scale;
    push_ = period_s * scale;
    stiffness_step_ = period_s * stiffness * scale;
  }
  /// It goes on from this motion.
  void start_at(Scalar angle_rad, Scalar rate_rad_s) {
    angle_ = angle_rad;
    rate_ = rate_rad_s;
  }
  /// One period on.
  Moved<Scalar> move(Scalar torque_nm, Scalar period_s) {
    // The second-order step y'' = w2 (in - y) - d2 y' with in = torque / C, written without the division.
    rate_ = rate_keep_ * rate_ + push_ * torque_nm - stiffness_step_ * angle_;
    const Scalar step = period_s * rate_;
    angle_ += step;
    return {angle_, step};
  }

 private:
  Scalar rate_keep_{0}, push_{0}, stiffness_step_{0};  ///< rate := rate_keep rate + push torque - stiffness_step angle
  Scalar angle_{0}, rate_{0};
};

}  // namespace steerid
