// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/prediction_remainder.hpp"

#include <algorithm>

#include "log/resample.hpp"

namespace steerid::gap {

std::vector<double> angles_at(const std::vector<double>& stamps_s, const std::vector<double>& time_s,
                              const std::vector<double>& angle_rad) {
  const double half_s = 0.5 / kResampledRateHz;
  std::vector<double> out(stamps_s.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto next = std::ranges::lower_bound(time_s, stamps_s[i] - half_s);
    if (next == time_s.end() || *next > stamps_s[i] + half_s) continue;
    out[i] = angle_rad[static_cast<std::size_t>(next - time_s.begin())];
  }
  return out;
}

}  // namespace steerid::gap
