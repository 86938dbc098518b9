// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Student's two-sided 95 % quantile: for estimates whose spread is itself known from a few values only.
#pragma once

#include <algorithm>

namespace steerid::gap {

inline constexpr double kNormal95 = 1.959964;

/// By the first terms in 1/free (Abramowitz and Stegun 26.7.5): 2.26 for nine degrees of freedom, 2.57 for five, to
/// half a percent from three on. Below two it stays at that of two.
[[nodiscard]] inline double student95(double free) {
  constexpr double kSquare = kNormal95 * kNormal95;
  constexpr double kCube = kNormal95 * kSquare;
  const double n = std::max(2.0, free);
  return kNormal95 + (kCube + kNormal95) / (4 * n) + (5 * kCube * kSquare + 16 * kCube + 3 * kNormal95) / (96 * n * n) +
         (3 * kCube * kSquare * kSquare + 19 * kCube * kSquare + 17 * kCube - 15 * kNormal95) / (384 * n * n * n);
}

}  // namespace steerid::gap
