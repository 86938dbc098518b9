// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The line through points by least squares: the clock behind messages, or rows, of which the numbers are known.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace steerid {

struct Line {
  double x0 = 0;  ///< the means, through which it goes
  double y0 = 0;
  double slope = 0;
  [[nodiscard]] double at(double x) const { return y0 + slope * (x - x0); }
};

/// y over x, of equal length, two different x at least.
[[nodiscard]] inline Line least_squares_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto mean = [](const std::vector<double>& values) {
    return std::reduce(values.begin(), values.end()) / static_cast<double>(values.size());
  };
  Line line{.x0 = mean(x), .y0 = mean(y)};
  double xx = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - line.x0) * (x[i] - line.x0);
    xy += (x[i] - line.x0) * (y[i] - line.y0);
  }
  line.slope = xy / xx;
  return line;
}

/// 0, 1, 2, ...
[[nodiscard]] inline std::vector<double> counted(std::size_t count) {
  std::vector<double> number(count);
  std::iota(number.begin(), number.end(), 0.0);
  return number;
}

}  // namespace steerid
