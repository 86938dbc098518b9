// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Akaike's criterion with the correction for short records (Hurvich and Tsai 1989): which of several models explains
// without too many numbers. The smaller the better; above a difference of ten the worse one has essentially no support
// (Burnham and Anderson, Model Selection and Multimodel Inference, 2002, section 2.6).
#pragma once

#include <limits>

namespace steerid {

inline constexpr double kNoSupport = 10;

/// `misfit`: -2 log likelihood; `numbers`: how many were estimated, the variance among them.
[[nodiscard]] inline double corrected_akaike(double misfit, double samples, int numbers) {
  const double spare = samples - numbers - 1;
  return spare > 0 ? misfit + 2 * numbers * samples / spare : std::numeric_limits<double>::infinity();
}

}  // namespace steerid
