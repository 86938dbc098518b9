// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Saturation: y is x, clipped to -limit .. limit.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "sensors/during.hpp"

namespace steerid::sensor {

struct Saturation {
  double limit = std::numeric_limits<double>::infinity();  ///< in the channel's unit, > 0; infinity is off
  During during;

  [[nodiscard]] double apply(double x, std::int64_t instant_us) const {
    return std::abs(x) > limit && during.covers(instant_us) ? std::copysign(limit, x) : x;
  }
};

}  // namespace steerid::sensor
