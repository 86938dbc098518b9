// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Scale error: y = factor x.
#pragma once

#include <cstdint>

#include "sensors/during.hpp"

namespace steerid::sensor {

struct Gain {
  double factor = 1;  ///< without unit; 1 is off, -1 a channel wired the wrong way round
  During during;

  [[nodiscard]] double apply(double x, std::int64_t instant_us) const {
    return factor != 1.0 && during.covers(instant_us) ? factor * x : x;
  }
};

}  // namespace steerid::sensor
