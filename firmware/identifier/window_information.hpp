// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the last seconds alone could tell about each parameter: the Fisher information of a sliding window.
//
// The window's information matrix is the sum of z z' over the last 2.5 to 5 s, z the instrument; the Cramer-Rao bound
// of that window is noise_variance (sum z z')^-1. Parameter i is called excited when the bound says that this window,
// by itself and with the other parameters unknown, would fix it to within its limit. That looks at the information's
// smallest direction: on a steady sine, where two numbers are visible and three are asked for, the bound of all that
// mix in the unexcited direction is large, however big the motion. The window ends sharply: a fading one would still
// see a strong probe, ten thousand times what is needed, forty seconds after its end.
//
// What the torque sensor's noise adds to z (noise_information.hpp) is no information and is taken off first. A
// parameter whose information, once C, or C and B, are known too, is not several times that of the noise is held: the
// motion does not show it, and only the noise would move it. The order C, B, J is that of the frequencies that show
// them.
#pragma once

#include <cstdint>

#include "base/square_root.hpp"
#include "identifier/noise_information.hpp"
#include "identifier/parameters.hpp"
#include "identifier/ud_covariance.hpp"

namespace steerid {

/// How many times better than the noise in the instrument pretends to the motion must show a parameter: what the noise
/// pulls it by is 1/80 of it then.
inline constexpr double kShown = 80;

/// What is held, of each parameter's share of noise (WindowInformation::noise_share) and the most that may be noise.
template <class Scalar>
[[nodiscard, gnu::noinline]] Held held_by(const Vector3<Scalar>& share, Scalar most) {
  if (!(share(kStiffness) < most)) return Held::kAll;
  if (!(share(kDamping) < most)) return Held::kInertiaAndDamping;
  return share(kInertia) < most ? Held::kNone : Held::kInertiaOnly;
}

template <class Scalar>
class WindowInformation {
 public:
  static constexpr int kBlock = 250;          ///< samples; the window is the block before and what there is of this one
  static constexpr int kTellsFrequency = 50;  ///< samples before it says at which frequency motion shows what

  void push(const Vector3<Scalar>& z) {
    if (samples_ == kBlock) {
      before_ = now_;
      samples_before_ = samples_;
      now_ = Block();
      samples_ = 0;
    }
    now_.push(z);
    ++samples_;
  }

  /// Cramer-Rao bound of the window's variance of each parameter, for measurement noise of variance 1; `unexcited`
  /// where the window has no information at all.
  [[nodiscard]] Vector3<Scalar> bound(Scalar unexcited, const NoiseInformation<Scalar>& noise = {},
                                      const Vector3<Scalar>& known = Vector3<Scalar>::Zero()) const {
    Block w = window();
    w.take_off(noise, static_cast<Scalar>(samples()));
    w.xx = at_least_nothing(w.xx) + known(0);
    w.yy = at_least_nothing(w.yy) + known(1);
    w.zz = at_least_nothing(w.zz) + known(2);
    // One step of elimination at a time, each pivot being what is left of a parameter's information once those
    // before it are unknown too; done for each parameter last.
    return Vector3<Scalar>(left(w.zz, w.yz, w.yy, w.xz, w.xy, w.xx, unexcited),
                           left(w.xx, w.xz, w.zz, w.xy, w.yz, w.yy, unexcited),
                           left(w.xx, w.xy, w.yy, w.xz, w.yz, w.zz, unexcited));
  }

  /// How much of each parameter's information, once C, or C and B, are known too, `noise` alone would make: 0 to 1.
  [[nodiscard]] Vector3<Scalar> noise_share(const NoiseInformation<Scalar>& noise) const {
    const Block w = window();
    const auto n = static_cast<Scalar>(samples());
    Vector3<Scalar> share = Vector3<Scalar>::Constant(Scalar(1));
    if (!(w.zz > n * noise.angle)) return share;
    share(kStiffness) = n * noise.angle / w.zz;
    const Scalar damping = w.yy - w.yz * w.yz / w.zz;
    const Scalar mixed = w.xy - w.xz * w.yz / w.zz;
    if (!(damping > n * noise.rate)) return share;
    share(kDamping) = n * noise.rate / damping;
    const Scalar inertia = w.xx - w.xz * w.xz / w.zz - mixed * mixed / damping;
    if (inertia > n * noise.acceleration_alone()) share(kInertia) = n * noise.acceleration_alone() / inertia;
    return share;
  }

  /// The angular frequency, squared, in 1/s2, at which slow torque, which falls off with w^-4, is as dense as in the
  /// mean over the power that shows each parameter. Of the acceleration's power that is the angle's over it: J's
  /// frequency is their ratio's fourth root. The same of the rate's power would take what is slower than the angle;
  /// that of the rate's over the angle's stands for B's and C's.
  [[nodiscard]] Vector3<Scalar> frequency_squared() const {
    const Block w = window();
    const auto ratio = [&](Scalar fast) { return w.zz > Scalar(0) ? fast / w.zz : Scalar(0); };
    const Scalar slow = ratio(w.yy);
    return Vector3<Scalar>(square_root(ratio(w.xx)), slow, slow);
  }

  /// The rate's power over the angle's, in 1/s2. While the window has only begun that of a motion between a driver's
  /// who steers and a probe's.
  [[nodiscard]] Scalar rate_over_angle() const {
    const Scalar angle = now_.zz + before_.zz;
    if (samples() < kTellsFrequency || !(angle > Scalar(0))) return Scalar(kUsual);
    return (now_.yy + before_.yy) / angle;
  }

  /// Mean of two squares that a rate and an angle have a part in, over the mean squares of z's own; 0 where one of
  /// their sums is not above `least`: a wheel that is held has no rate, one that is let go at its zero no angle.
  [[nodiscard]] Scalar over_the_motion(Scalar rate_square, Scalar angle_square, Scalar least) const {
    const Scalar rate = now_.yy + before_.yy;
    const Scalar angle = now_.zz + before_.zz;
    if (!(rate > least && angle > least)) return Scalar(0);
    return Scalar(0.5) * static_cast<Scalar>(samples()) * (rate_square / rate + angle_square / angle);
  }

  [[nodiscard]] int samples() const { return samples_ + samples_before_; }
  [[gnu::cold, gnu::noinline]] void reset() { *this = WindowInformation(); }

 private:
  /// Sums of the products of z's components (x, y, z for J, B, C).
  struct Block {
    Scalar xx{0}, xy{0}, xz{0}, yy{0}, yz{0}, zz{0};

    void push(const Vector3<Scalar>& z) {
      xx += z(0) * z(0);
      xy += z(0) * z(1);
      xz += z(0) * z(2);
      yy += z(1) * z(1);
      yz += z(1) * z(2);
      zz += z(2) * z(2);
    }
    void take_off(const NoiseInformation<Scalar>& noise, Scalar n) {
      xx -= n * noise.acceleration;
      xz += n * noise.rate;
      yy -= n * noise.rate;
      zz -= n * noise.angle;
    }
  };

  [[nodiscard]] Block window() const {
    return {now_.xx + before_.xx, now_.xy + before_.xy, now_.xz + before_.xz,
            now_.yy + before_.yy, now_.yz + before_.yz, now_.zz + before_.zz};
  }

  static Scalar at_least_nothing(Scalar x) { return x > Scalar(0) ? x : Scalar(0); }

  /// Last pivot of the symmetric matrix [a b d; b c e; d e f], inverted.
  [[gnu::cold, gnu::noinline]] static Scalar left(Scalar a, Scalar b, Scalar c, Scalar d, Scalar e, Scalar f,
                                                  Scalar unexcited) {
    if (!(a > Scalar(0))) return unexcited;
    // A pivot that rounding has eaten says that the first two cannot be told apart, not that the third is unseen.
    Scalar c1 = c - b * b / a;
    if (!(c1 > Scalar(kEmpty) * c)) c1 = Scalar(kEmpty) * c;
    if (!(c1 > Scalar(0))) return unexcited;
    const Scalar e1 = e - b * d / a;
    const Scalar f1 = f - d * d / a - e1 * e1 / c1;
    if (!(f1 > Scalar(kEmpty) * f)) return unexcited;
    const Scalar variance = Scalar(1) / f1;
    return variance < unexcited ? variance : unexcited;
  }

  static constexpr double kUsual = 25;    ///< 1/s2
  static constexpr double kEmpty = 1e-6;  ///< share of a pivot below which rounding is all that is left of it
  Block now_, before_;
  std::uint8_t samples_ = 0, samples_before_ = 0;  ///< at most kBlock
};

}  // namespace steerid
