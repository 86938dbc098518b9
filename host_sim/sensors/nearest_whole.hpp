// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Rounding to whole numbers without a call: std::nearbyint() is a library function on the oldest x86-64.
#pragma once

#include <cmath>

namespace steerid {

/// The whole number nearest to x, ties to the even one. Below 2^51 in magnitude the sum with 1.5 * 2^52 has no digits
/// behind the point left, so that the processor's own rounding (IEEE 754, to nearest) does it.
[[nodiscard]] inline double nearest_whole(double x) {
  constexpr double kNoFraction = 0x1.8p52;
  return std::abs(x) < 0x1p51 ? (x + kNoFraction) - kNoFraction : std::nearbyint(x);
}

}  // namespace steerid
