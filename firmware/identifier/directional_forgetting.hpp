// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How the steady identifier forgets: what is known may go stale only where the motion shows it, and what poorer
// instruments taught goes first. Another rule is another class with these members, named in identifier.hpp.
//
//   P := (1 + s) P                                     s begins at a share and fades with exp(-T / 1.5 s)
//   P := P + Pd z z' Pd / (1 + z' Pd z)                Pd = diag(floor^2 p_i^2) / s2 (Stenlund and Gustafsson 2002)
//
// with the instrument z and the noise's variance s2. Beside a measurement of z, which takes P z z' P / (1 + z' P z)
// away, P returns to Pd in every direction that is excited, whatever it was, and stays in every other one: nothing
// winds up. Parameters that are held are left alone by both.
//
// Units: those of the covariance (ud_covariance.hpp). Cost a sample: some 40 multiplications, 3 divisions. 4 bytes in
// float.
#pragma once

#include "identifier/parameters.hpp"
#include "identifier/ud_covariance.hpp"

namespace steerid {

template <class Scalar>
class DirectionalForgetting {
 public:
  /// From now on everything is forgotten, by this share a sample at first; 0 ends it.
  void forget_all(Scalar share) { of_all_ = share; }
  /// That share times `by`, beside its own fading.
  void fade(Scalar by) { of_all_ *= by; }

  /// Once a sample. `p` is J, B and C, `floor_square` the square of the relative standard deviation that P returns to
  /// over the noise's variance.
  template <class Parameters>
  [[gnu::always_inline]] void forget(UdCovariance<Scalar>& covariance, const Parameters& p, const Vector3<Scalar>& z,
                                     Scalar floor_square, Held held) {
    if (held == Held::kAll) return;
    covariance.scale(Scalar(1) + of_all_, held);
    of_all_ *= Scalar(kFade);
    Vector3<Scalar> back;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) back(i) = p(i) * p(i) * floor_square * z(i);
    if (holds(held, kInertia)) back(kInertia) = Scalar(0);
    if (holds(held, kDamping)) back(kDamping) = Scalar(0);
    covariance.spread(back, Scalar(1) / (Scalar(1) + z.dot(back)));
  }

 private:
  static constexpr double kFade = 0.99335;  ///< exp(-T / 1.5 s)

  Scalar of_all_{0};
};

}  // namespace steerid
