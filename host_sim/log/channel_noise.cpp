// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/channel_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "log/neighbours.hpp"
#include "log/quantile.hpp"

namespace steerid {

double white_noise_deviation(std::span<const double> x) {
  constexpr std::size_t kFewest = 20;
  constexpr double kAlternates = 0.65;  // share of the differences; white noise has 0.795, a slow motion 0.1
  std::vector<double> off;
  for (std::size_t i = 2; i + 2 < x.size(); ++i) {
    const double difference = x[i] - by_neighbours(x, i);
    if (difference != 0) off.push_back(difference);
  }
  if (off.size() < kFewest) return 0;
  std::size_t alternating = 0;
  for (std::size_t i = 1; i < off.size(); ++i) alternating += (off[i] > 0) != (off[i - 1] > 0) ? 1 : 0;
  if (static_cast<double>(alternating) < kAlternates * static_cast<double>(off.size())) return 0;
  for (double& difference : off) difference = std::abs(difference);
  return median(std::move(off)) * 6 / (kMedianOfNormal * std::sqrt(70.0));
}

double smallest_step(std::span<const double> x) {
  std::vector<double> sorted(x.begin(), x.end());
  std::ranges::sort(sorted);
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] > sorted[i - 1]) step = std::min(step, sorted[i] - sorted[i - 1]);
  }
  return step;
}

bool repeats_tell(double deviation, std::span<const double> x) {
  constexpr double kSteps = 10;
  return deviation > kSteps * smallest_step(x);
}

}  // namespace steerid
