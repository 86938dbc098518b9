// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/lost_samples.hpp"

#include <array>
#include <cstddef>

namespace steerid::gap {

std::vector<double> over_lost_samples(std::vector<double> angle_rad, const std::vector<char>& lost) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < angle_rad.size(); ++i) {
    if (lost[i] == 0) kept.push_back(i);
  }
  for (std::size_t k = 1; k + 2 < kept.size(); ++k) {
    const std::array<std::size_t, 4> nodes = {kept[k - 1], kept[k], kept[k + 1], kept[k + 2]};
    for (std::size_t i = nodes[1] + 1; i < nodes[2]; ++i) {
      double value = 0;
      for (const std::size_t node : nodes) {  // Lagrange's form
        double weight = 1;
        for (const std::size_t other : nodes) {
          if (other == node) continue;
          weight *= (static_cast<double>(i) - static_cast<double>(other)) /
                    (static_cast<double>(node) - static_cast<double>(other));
        }
        value += weight * angle_rad[node];
      }
      angle_rad[i] = value;
    }
  }
  return angle_rad;
}

double kept_noise_variance(const std::vector<double>& angle_rad, const std::vector<char>& lost) {
  constexpr std::size_t kFewest = 100;
  constexpr double kGain = 1 + (1.0 + 16 + 16 + 1) / 36;  // of the white noise's variance
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 2; i + 2 < angle_rad.size(); ++i) {
    const bool kept = lost[i - 2] == 0 && lost[i - 1] == 0 && lost[i] == 0 && lost[i + 1] == 0 && lost[i + 2] == 0;
    if (!kept) continue;
    const double between = (4 * (angle_rad[i - 1] + angle_rad[i + 1]) - angle_rad[i - 2] - angle_rad[i + 2]) / 6;
    squares += (angle_rad[i] - between) * (angle_rad[i] - between);
    ++count;
  }
  return count < kFewest ? 0 : squares / static_cast<double>(count) / kGain;
}

}  // namespace steerid::gap
