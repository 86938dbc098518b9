// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// When a defect acts: faults come and go.
#pragma once

#include <cstdint>
#include <limits>

namespace steerid::sensor {

/// From `onset_s` for `length_s` seconds of simulated time since the start; always, unless told otherwise.
struct During {
  double onset_s = 0;                                         ///< >= 0
  double length_s = std::numeric_limits<double>::infinity();  ///< >= 0; 0 is never

  [[nodiscard]] constexpr bool covers(std::int64_t instant_us) const {
    const double elapsed_s = static_cast<double>(instant_us) * 1e-6 - onset_s;
    return elapsed_s >= 0.0 && elapsed_s < length_s;
  }
};

}  // namespace steerid::sensor
