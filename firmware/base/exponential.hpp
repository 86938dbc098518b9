// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// exp(-x) without libm, the same bits on every target.
//
//   exp(-x) = (1 - x/64 + (x/64)^2 / 2)^64,   0 <= x <= 16
//
// The bracket is exp(-x/64) within (x/64)^3 / 6; the power makes 64 times that of it: 1e-4 of the value at x = 1, 2 %
// at x = 6, 40 % at x = 16. It weighs likelihoods, where that is far below what a noise variance is known to. Cost: 9
// multiplications.
#pragma once

namespace steerid {

/// exp(-x); x below 0 counts as 0, above 16 as 16.
template <class Scalar>
[[nodiscard, gnu::noinline]] constexpr Scalar exponential_of_minus(Scalar x) {
  if (!(x > Scalar(0))) return Scalar(1);
  if (x > Scalar(16)) x = Scalar(16);
  const Scalar part = x * Scalar(1.0 / 64.0);
  Scalar power = Scalar(1) - part + part * part * Scalar(0.5);
  for (int i = 0; i < 6; ++i) power = power * power;
  return power;
}

}  // namespace steerid
