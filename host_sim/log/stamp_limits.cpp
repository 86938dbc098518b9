// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/stamp_limits.hpp"

#include <cmath>

#include "log/units.hpp"

namespace steerid {

std::string likely_time_unit(double stamp, double apart) {
  for (const char* unit : {"ms", "us"}) {
    const double a_second = *units_per_si(Quantity::kTime, unit);
    if (std::abs(stamp) <= kLatestTimeS * a_second && apart * kLowestRateHz <= a_second) return unit;
  }
  return "ns";
}

}  // namespace steerid
