// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel's motion in closed form, for tests of how its messages are read.
#pragma once

#include <cmath>
#include <numbers>

namespace steerid::test {

/// Tones of 0.4 to 3.7 Hz, each of the same rate.
inline double motion_rad(double t) {
  double sum = 0;
  for (const double hz : {0.4, 1.1, 2.3, 3.7}) sum += 0.1 / hz * std::cos(2 * std::numbers::pi * hz * t + 3 * hz);
  return sum;
}

}  // namespace steerid::test
