// What the last seconds alone could tell about each parameter: the Fisher information of a sliding window.
//
// The window's information matrix is the exponentially weighted sum of z z' over about 5 s, z the instrument; the
// Cramer-Rao bound of that window is noise_variance (sum z z')^-1. Parameter i is called excited when the bound says
// that this window, by itself and with the other parameters unknown, would fix it to within its limit. That looks at
// the information's smallest direction: on a steady sine, where two numbers are visible and three are asked for, the
// bound of all that mix in the dark direction is large, however big the motion.
#pragma once

#include "identifier/parameters.hpp"

namespace steerid {

template <class Scalar>
class WindowInformation {
 public:
  static constexpr int kWindow = 500;  ///< samples

  void push(const Vector3<Scalar>& z) {
    const Scalar rate = Scalar(1.0 / kWindow);
    xx_ += rate * (z(0) * z(0) - xx_);
    xy_ += rate * (z(0) * z(1) - xy_);
    xz_ += rate * (z(0) * z(2) - xz_);
    yy_ += rate * (z(1) * z(1) - yy_);
    yz_ += rate * (z(1) * z(2) - yz_);
    zz_ += rate * (z(2) * z(2) - zz_);
  }

  /// Cramer-Rao bound of the window's variance of each parameter, for measurement noise of variance 1; `dark` where
  /// the window has no information at all.
  [[nodiscard]] Vector3<Scalar> bound(Scalar dark) const {
    // One step of elimination at a time, each pivot being what is left of a parameter's information once those
    // before it are unknown too; done for each parameter last.
    return Vector3<Scalar>(left(zz_, yz_, yy_, xz_, xy_, xx_, dark), left(xx_, xz_, zz_, xy_, yz_, yy_, dark),
                           left(xx_, xy_, yy_, xz_, yz_, zz_, dark));
  }

  void reset() { *this = WindowInformation(); }

 private:
  /// Last pivot of the symmetric matrix [a b d; b c e; d e f] times the window, inverted.
  static Scalar left(Scalar a, Scalar b, Scalar c, Scalar d, Scalar e, Scalar f, Scalar dark) {
    if (!(a > Scalar(0))) return dark;
    // A pivot that rounding has eaten says that the first two cannot be told apart, not that the third is unseen.
    Scalar c1 = c - b * b / a;
    if (!(c1 > Scalar(kEmpty) * c)) c1 = Scalar(kEmpty) * c;
    if (!(c1 > Scalar(0))) return dark;
    const Scalar e1 = e - b * d / a;
    const Scalar f1 = f - d * d / a - e1 * e1 / c1;
    if (!(f1 > Scalar(kEmpty) * f)) return dark;
    const Scalar variance = Scalar(1) / (f1 * Scalar(kWindow));
    return variance < dark ? variance : dark;
  }

  static constexpr double kEmpty = 1e-6;  ///< share of a pivot below which rounding is all that is left of it
  Scalar xx_{0}, xy_{0}, xz_{0}, yy_{0}, yz_{0}, zz_{0};
};

}  // namespace steerid
