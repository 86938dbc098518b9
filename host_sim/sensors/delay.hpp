// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Pure delay: y(t) = x(t - delay). A channel cannot show the future: to shift it the other way, delay the others.
#pragma once

#include <cstdint>

#include "sensors/during.hpp"

namespace steerid::sensor {

struct Delay {
  static constexpr std::int64_t kLongestUs = 500'000;  ///< what a channel remembers

  std::int64_t delay_us = 0;  ///< 0 to kLongestUs, any microsecond, not only whole ticks; 0 is off
  During during;

  /// The instant whose signal shows at `instant_us`.
  [[nodiscard]] std::int64_t source_us(std::int64_t instant_us) const {
    return delay_us != 0 && during.covers(instant_us) ? instant_us - delay_us : instant_us;
  }
};

}  // namespace steerid::sensor
