// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The measured angle at which the arm pulls with no torque: where the arm rests, off the zero of the angle's sensor.
//
//   y = T - J th'' - B th' = C (th - th0) + v      v: what no sensor explains
//   th = th0 + s y - v / C                         s = 1 / C
//
// An offset of the angle is a constant torque C th0, which is another one whenever C is: who takes it for noise takes
// an arm that stiffens for noise as well. In th0 and s the equation is linear, and th0 is the angle at which y is zero
// whatever C was meanwhile. So a Kalman filter of two states finds it, th0 that stays and s that walks as an arm does
// that moves; its covariance is kept as U D U' (Bierman 1977, Factorization Methods for Discrete Sequential Estimation,
// chapter 5), which rounding leaves positive. A curve that is held does not tell th0 from s; there it stays as it is.
// v is in y, too: it makes s smaller, which moves th0 only as far as y has a mean.
//
// No offset is assumed until the data contradict that by three deviations: where there is none nothing else changes.
// One of more than 0.06 rad is not the sensor's: a joint that something holds off its rest, as a measured ankle does.
// Only where all torque is known: a driver's own has a mean of its own.
//
// Units: rad, Nm, rad/Nm. 28 bytes in float. Cost a look: some 30 products, four divisions.
#pragma once

#include "identifier/arm_walks.hpp"

namespace steerid {

template <class Scalar>
class RestAngle {
 public:
  /// rad; 0 as long as there may be none.
  [[nodiscard]] Scalar angle_rad() const { return shown_; }

  /// One look: th less angle_rad(), and y; to begin with C in Nm/rad and the variance of v in Nm^2.
  void look(Scalar turned_rad, Scalar spring_nm, Scalar stiffness, Scalar noise_nm2) {
    if (!(of_compliance_ > Scalar(0))) begin(stiffness, noise_nm2);
    walk();
    const Scalar noise = Scalar(kCorrelated) * noise_;
    const Scalar by = with_it_ + spring_nm;
    const Scalar by_compliance = of_compliance_ * by;
    const Scalar by_rest = of_rest_ + with_it_ * by_compliance;
    const Scalar given = noise + of_rest_;
    const Scalar unknown = of_rest_ + by * by_compliance;
    const Scalar share = Scalar(1) / given;
    const Scalar spread = Scalar(1) / (noise + unknown);
    const Scalar off = turned_rad + shown_ - rest_ - compliance_ * spring_nm;
    const Scalar gain = off * spread;
    rest_ += by_rest * gain;
    compliance_ += by_compliance * gain;
    with_it_ -= by * of_rest_ * share;
    of_rest_ = of_rest_ * noise * share;
    of_compliance_ = of_compliance_ * given * spread;
    noise_ += noise_ * (off * off / (noise_ + unknown) - Scalar(1)) * Scalar(kNoiseShare);
    if (noise_ < Scalar(kLeastNoise)) noise_ = Scalar(kLeastNoise);
    if (compliance_ < Scalar(1 / kStiffest)) compliance_ = Scalar(1 / kStiffest);
    if (compliance_ > Scalar(1 / kSoftest)) compliance_ = Scalar(1 / kSoftest);
    const Scalar variance = of_rest_ + with_it_ * with_it_ * of_compliance_;
    const Scalar square = rest_ * rest_;
    if (square > Scalar(kMost_rad * kMost_rad)) {
      shown_ = Scalar(0);
    } else if (shown_ != Scalar(0) || square > Scalar(kShows * kShows) * variance) {
      shown_ = rest_;
    }
  }

 private:
  static constexpr double kPrior_rad = 0.02;  ///< a degree: what mounting and alignment leave of an angle's zero
  static constexpr double kShows = 3;         ///< deviations
  static constexpr double kMost_rad = kShows * kPrior_rad;
  /// Variance a look: of s as of C of an arm that moves; and of th0, 0.1 mrad within a second, rad^2.
  static constexpr double kCompliance = kWalksByTorque<double>.of[kArmMoves].stiffness;
  static constexpr double kRest = 1e-8 * ArmWalks<double>::kPeriod_s;
  /// Looks for which v is the same: of a torque with a corner of 0.3 Hz 2 / (2 pi 0.3 Hz 40 ms).
  static constexpr double kCorrelated = 26.5;
  static constexpr double kNoiseShare = 0.002;            ///< a look: the last 20 s
  static constexpr double kLeastNoise = 1e-12 / 12;       ///< rad^2: the rounding of the port's angle
  static constexpr double kStiffest = 300, kSoftest = 1;  ///< Nm/rad

  void begin(Scalar stiffness, Scalar noise_nm2) {
    compliance_ = Scalar(1) / (stiffness > Scalar(kSoftest) ? stiffness : Scalar(kSoftest));
    of_compliance_ = compliance_ * compliance_;
    noise_ = of_compliance_ * noise_nm2;
  }
  /// s is never less known than not at all.
  void walk() {
    const Scalar most = compliance_ * compliance_;
    const Scalar more = Scalar(kCompliance) * most;
    const Scalar kept = of_compliance_ / (of_compliance_ + more);
    of_rest_ += with_it_ * with_it_ * more * kept + Scalar(kRest);
    with_it_ *= kept;
    of_compliance_ += more;
    if (of_compliance_ > most) of_compliance_ = most;
  }

  Scalar shown_{0};
  Scalar noise_{0};  ///< variance of v / C, rad^2
  Scalar rest_{0}, compliance_{0};
  /// The variance of th0 with s known, how th0 goes with s, and the variance of s.
  Scalar of_rest_{Scalar(kPrior_rad * kPrior_rad)}, with_it_{0}, of_compliance_{0};
};

}  // namespace steerid
