// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/prediction_remainder.hpp"

#include <algorithm>
#include <cmath>

#include "log/resample.hpp"

namespace steerid::gap {

std::vector<double> PredictionRemainder::at(const std::vector<double>& stamps_s, double origin_s) const {
  std::vector<double> out(stamps_s.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double stamp_s = stamps_s[i] + origin_s - 0.5 / kResampledRateHz;
    const auto next = std::ranges::lower_bound(time_s, stamp_s);
    if (next == time_s.end() || *next > stamp_s + 1 / kResampledRateHz) continue;
    out[i] = angle_rad[static_cast<std::size_t>(next - time_s.begin())];
  }
  return out;
}

}  // namespace steerid::gap
