// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/anti_alias.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "log/kaiser_sinc.hpp"

namespace steerid {
namespace {

constexpr double kAttenuationDb = 90.0;  // so that the images of a slower record, which add up, stay 80 dB down too
constexpr std::size_t kPoints = 16384;

}  // namespace

AntiAlias anti_alias_for(double source_rate_hz) {
  const double lower_hz = std::min(source_rate_hz, kResampledRateHz);
  const double pass_hz = 0.3 * lower_hz;
  const double stop_hz = 0.5 * lower_hz;
  return {pass_hz, stop_hz, kaiser_half_length_s(kAttenuationDb, stop_hz - pass_hz)};
}

AntiAliasKernel::AntiAliasKernel() : table_(kPoints + 2) {
  const AntiAlias filter = anti_alias_for(kResampledRateHz);
  const double cutoff_hz = 0.5 * (filter.pass_hz + filter.stop_hz);
  for (std::size_t i = 0; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kPoints);
    table_[i] = sinc(2.0 * std::numbers::pi * cutoff_hz * filter.half_length_s * share) *
                kaiser_window(kaiser_beta(kAttenuationDb), share);
  }
}

double AntiAliasKernel::at(double share) const {
  const double place = std::abs(share) * static_cast<double>(kPoints);
  if (place >= static_cast<double>(kPoints)) return 0.0;
  const auto i = static_cast<std::size_t>(place);
  return table_[i] + (place - static_cast<double>(i)) * (table_[i + 1] - table_[i]);
}

}  // namespace steerid
