// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Sampling jitter: the sensors are read late by a random time, all three together:
//   instant = tick + u, u uniform in whole microseconds over 0 .. spread_us (standard deviation spread / sqrt(12)).
// With `stamped` the stamp tells the true instant, and only the spacing is uneven. Without it the stamp says the tick
// plus the mean of u: an error in time that shows as noise in proportion to the signals' slopes.
#pragma once

#include <cstdint>

#include "sensors/during.hpp"
#include "sensors/random.hpp"

namespace steerid::sensor {

struct Jitter {
  static constexpr std::int64_t kWidestUs = 9'999;  ///< below one tick: samples keep their order

  std::int64_t spread_us = 0;  ///< 0 to kWidestUs; 0 is off
  bool stamped = true;
  During during;

  struct Instants {
    std::int64_t sampled_us;
    std::int64_t stamp_us;
  };

  [[nodiscard]] Instants at(std::int64_t tick_us, Random& random) const {
    if (spread_us == 0) return {tick_us, tick_us};
    const auto u = static_cast<std::int64_t>(random.uniform() * static_cast<double>(spread_us + 1));
    if (!during.covers(tick_us)) return {tick_us, tick_us};
    return {tick_us + u, tick_us + (stamped ? u : spread_us / 2)};
  }
};

}  // namespace steerid::sensor
