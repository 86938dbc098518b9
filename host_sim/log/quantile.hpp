// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Quantiles by selection.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace steerid {

/// The value that `share` (0 to 1) of them stay below or at; there is one at least.
[[nodiscard]] inline double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

/// Median size of a normal variable, in its deviations. Its square is the median of a chi-square of one degree of
/// freedom.
inline constexpr double kMedianOfNormal = 0.67448975;

/// The middle one, of an even number the upper of the two; there is one at least.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace steerid
