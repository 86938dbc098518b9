// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Finite resolution: y is the multiple of `step` nearest to x. The error of a signal that moves over many steps is
// uniform, its standard deviation step / sqrt(12).
#pragma once

#include <cstdint>

#include "sensors/during.hpp"
#include "sensors/nearest_whole.hpp"

namespace steerid::sensor {

struct Resolution {
  double step = 0;  ///< in the channel's unit, >= 0; 0 is off
  During during;

  [[nodiscard]] double apply(double x, std::int64_t instant_us) const {
    return step > 0.0 && during.covers(instant_us) ? step * nearest_whole(x / step) : x;
  }
};

}  // namespace steerid::sensor
