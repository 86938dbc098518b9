// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Offset and drift: y = x + offset + drift_per_s (t - onset).
#pragma once

#include <cstdint>

#include "sensors/during.hpp"

namespace steerid::sensor {

struct Bias {
  double offset = 0;       ///< in the channel's unit; 0 is off
  double drift_per_s = 0;  ///< in the channel's unit per second, counted from the onset; 0 is off
  During during;

  [[nodiscard]] double apply(double x, std::int64_t instant_us) const {
    if ((offset == 0.0 && drift_per_s == 0.0) || !during.covers(instant_us)) return x;
    return x + offset + drift_per_s * (static_cast<double>(instant_us) * 1e-6 - during.onset_s);
  }
};

}  // namespace steerid::sensor
