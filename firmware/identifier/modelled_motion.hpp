// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The instrument where all torque is known: the motion of a wheel like this one under all of the torque, and which
// parameters it shows.
//
// The torque sensor's noise moves the modelled wheel as well, and there it pretends to a motion that shows J, B and C
// (noise_information.hpp): on a straight road that is all there is. So the instrument's power over the last 0.8 to 1.6
// s is compared with what the noise would make of it; a parameter whose derivative has less than kShown times as much
// is dark. At that ratio the noise pulls an estimate by 1/20, half of what counts as learned. The window ends sharply,
// as that of window_information.hpp: a fading one would still see a strong probe seconds after its end.
//
// Units: Nm, rad, s. Cost: a sample 4 products and a differentiator; a look 3 products.
#pragma once

#include <cstdint>

#include "identifier/differentiator.hpp"
#include "identifier/free_wheel.hpp"
#include "identifier/noise_information.hpp"
#include "identifier/parameters.hpp"
#include "identifier/second_order_filter.hpp"

namespace steerid {

template <class Scalar>
class ModelledMotion {
 public:
  /// From the motion that was measured: `moved` is the newest of what `measured` holds.
  void start(const Vector3<Scalar>& arm, const Moved<Scalar>& moved, const Differentiator<Scalar>& measured,
             Scalar period_s) {
    wheel_.become(arm, period_s);
    wheel_.start_at(moved.to, moved.by * (Scalar(1) / period_s));
    motion_ = measured;
  }
  /// One sample of the torque behind the common filter.
  void push(Scalar torque_nm, Scalar period_s) { motion_.push(wheel_.move(torque_nm, period_s)); }
  /// As Differentiator::derivatives().
  [[nodiscard]] Vector3<Scalar> derivatives(Scalar rate_hz) const { return motion_.derivatives(rate_hz); }

  /// At every look: derivatives(), and the arm that the wheel goes on as.
  void look(const Vector3<Scalar>& derivatives, const Vector3<Scalar>& arm, Scalar period_s) {
    for (int i = 0; i < 3; ++i) now_(i) += derivatives(i) * derivatives(i);
    ++looks_;
    wheel_.become(arm, period_s);
  }
  /// Now and then: what the torque's noise pretends to, of the same wheel behind the same filter, a look.
  void compare(const NoiseInformation<Scalar>& pretended) {
    const Scalar pretends[3] = {pretended.acceleration, pretended.rate, pretended.angle};
    const auto looks = static_cast<Scalar>(looks_ + looks_before_);
    for (int i = 0; i < 3; ++i) dark_[i] = !(now_(i) + before_(i) > Scalar(kShown) * looks * pretends[i]);
    if (looks_ < kBlock) return;
    before_ = now_;
    looks_before_ = looks_;
    now_.setConstant(Scalar(0));
    looks_ = 0;
  }

  /// Of J, B and C: that the motion does not show it.
  using Dark = bool[3];
  [[nodiscard]] const Dark& dark() const { return dark_; }
  [[nodiscard]] bool shows_something() const { return !(dark_[0] && dark_[1] && dark_[2]); }

 private:
  static constexpr double kShown = 20;
  static constexpr std::int8_t kBlock = 20;  ///< looks

  FreeWheel<Scalar> wheel_;
  Differentiator<Scalar> motion_;
  /// Sums of squares over this block of looks and the one before.
  Vector3<Scalar> now_ = Vector3<Scalar>::Constant(Scalar(0));
  Vector3<Scalar> before_ = Vector3<Scalar>::Constant(Scalar(0));
  std::int8_t looks_ = 0, looks_before_ = 0;
  bool dark_[3] = {};
};

}  // namespace steerid
