// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Student's two-sided 95 % quantile: for estimates whose spread is itself known from a few values only.
#pragma once

#include <algorithm>

#include "fit/certainty.hpp"

namespace steerid::gap {

/// Deviations of a normal distribution that chance exceeds once in 370 times, and once in 16,000.
inline constexpr double kOnceIn370 = 3;
inline constexpr double kOnceIn16000 = 4;

/// By the first terms in 1/free (Abramowitz and Stegun 26.7.5): 2.26 for nine degrees of freedom, 2.57 for five, to
/// half a percent from three on. Below two it stays at that of two.
[[nodiscard]] inline double student95(double free) {
  constexpr double z = kNormal95;
  constexpr double cube = z * (z * z);
  const double n = std::max(2.0, free);
  return z + (cube + z) / (4 * n) + (5 * cube * (z * z) + 16 * cube + 3 * z) / (96 * n * n) +
         (3 * cube * (z * z) * (z * z) + 19 * cube * (z * z) + 17 * cube - 15 * z) / (384 * n * n * n);
}

}  // namespace steerid::gap
