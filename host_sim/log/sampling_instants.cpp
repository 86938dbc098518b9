// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/sampling_instants.hpp"

#include <cmath>
#include <cstddef>

#include "log/neighbours.hpp"

namespace steerid {
namespace {

/// By how much every stamp strays from the grid through all of them, s.
std::vector<double> strays_of(const std::vector<double>& time_s, const std::vector<double>& grid_s) {
  std::vector<double> stray(time_s.size());
  double mean = 0;
  for (std::size_t i = 0; i < stray.size(); ++i) mean += stray[i] = time_s[i] - grid_s[i];
  mean /= static_cast<double>(stray.size());
  for (double& one : stray) one -= mean;
  return stray;
}

}  // namespace

std::vector<double> even_stamps(const std::vector<double>& time_s, double period_s) {
  std::vector<double> grid_s(time_s.size());
  for (std::size_t i = 0; i < grid_s.size(); ++i) {
    grid_s[i] = time_s.front() + period_s * std::round((time_s[i] - time_s.front()) / period_s);
  }
  return grid_s;
}

bool evenly_sampled(const std::vector<double>& time_s, double period_s, std::span<const std::vector<double>> channels) {
  constexpr std::size_t kFewest = 100;
  constexpr double kSure = 0.1;  // deviation of s
  const std::size_t n = time_s.size();
  if (n < kFewest) return false;
  const std::vector<double> stray = strays_of(time_s, even_stamps(time_s, period_s));
  const auto samples = static_cast<double>(n - 4);
  double weight = 0;
  double sum = 0;
  std::vector<double> moved(n);
  for (const std::vector<double>& x : channels) {
    if (x.empty()) continue;
    for (std::size_t i = 1; i + 1 < n; ++i) moved[i] = (x[i + 1] - x[i - 1]) / (2 * period_s) * stray[i];
    moved[0] = moved[n - 1] = 0;
    double both = 0;
    double of_moved = 0;
    double of_x = 0;
    for (std::size_t i = 2; i + 2 < n; ++i) {
      const double a = x[i] - by_neighbours(x, i);
      const double b = moved[i] - by_neighbours(moved, i);
      both += a * b;
      of_moved += b * b;
      of_x += a * a;
    }
    if (!(of_moved > 0) || !(of_x > 0)) continue;
    const double s = both / of_moved;
    const double left = std::max(of_x - s * both, 1e-6 * of_x) / samples;  // variance; neighbours share some of it
    weight += of_moved / left;
    sum += s * of_moved / left;
  }
  constexpr double kShared = 2;
  return weight * kSure * kSure > kShared && sum < 0.5 * weight;
}

}  // namespace steerid
