// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/wrapped_angle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steerid {

std::size_t count_turns(std::vector<double>& angle_rad) {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  constexpr double kRounding = 1e-3;  // of a turn
  constexpr double kMost = 0.1;       // turns from one value to the next
  constexpr std::size_t kFewest = 2;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  double before = std::numeric_limits<double>::quiet_NaN();
  std::size_t jumps = 0;
  for (const double angle : angle_rad) {
    if (std::isnan(angle)) continue;
    least = std::min(least, angle);
    most = std::max(most, angle);
    const double step = std::abs(angle - before) / kTurn_rad;
    before = angle;
    if (!(step > kMost)) continue;
    if (step < 1 - kMost) return 0;
    ++jumps;
  }
  if (jumps < kFewest || most - least > (1 + kRounding) * kTurn_rad) return 0;
  double turns = 0;
  double sum = 0;
  double count = 0;
  before = std::numeric_limits<double>::quiet_NaN();
  for (double& angle : angle_rad) {
    if (std::isnan(angle)) continue;
    const double step = (angle - before) / kTurn_rad;
    before = angle;
    if (std::abs(step) > kMost) turns -= std::round(step);
    angle += turns * kTurn_rad;
    sum += angle;
    ++count;
  }
  const double whole_rad = kTurn_rad * std::round(sum / (count * kTurn_rad));
  for (double& angle : angle_rad) angle -= whole_rad;
  return jumps;
}

}  // namespace steerid
