// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/spikes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "log/neighbours.hpp"
#include "log/record_quality.hpp"

namespace steerid {
namespace {

std::size_t mend(std::vector<double>& x, const std::vector<GapFreeRows>& stretches) {
  constexpr double kFar = 15;
  constexpr double kAlone = 4;
  constexpr std::size_t kOneIn = 333;
  std::vector<double> off(x.size(), 0.0);
  for (const GapFreeRows& rows : stretches) {
    for (std::size_t i = rows.begin + 2; i + 2 < rows.end; ++i) off[i] = std::abs(x[i] - by_neighbours(x, i));
  }
  if (off.size() < 2) return 0;
  std::vector<double> sorted = off;
  const auto usual = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() - 1 - sorted.size() / 20);
  std::ranges::nth_element(sorted, usual);
  if (!(*usual > 0)) return 0;  // a channel that mostly stands still
  std::vector<std::pair<std::size_t, double>> spikes;
  for (std::size_t i = 2; i + 2 < x.size(); ++i) {
    const double rest =
        std::max({std::abs(x[i + 1] - x[i - 1]), std::abs(x[i - 1] - x[i - 2]), std::abs(x[i + 2] - x[i + 1])});
    if (off[i] > kFar * *usual && off[i] > kAlone * rest) spikes.emplace_back(i, by_neighbours(x, i));
  }
  if (spikes.size() * kOneIn > x.size()) return 0;
  for (const auto& [i, value] : spikes) x[i] = value;
  return spikes.size();
}

}  // namespace

std::string Spikes::note() const {
  std::string counted;
  for (const Channel channel : kAllChannels) {
    if (of(channel) == 0) continue;
    counted += fmt::format("{}{} of {}", counted.empty() ? "" : ", ", of(channel), channel_name(channel));
  }
  if (counted.empty()) return counted;
  return fmt::format("samples that stand alone, far from their neighbours, were replaced by what these say: {}",
                     counted);
}

Spikes mend_spikes(Record& record) {
  const std::vector<GapFreeRows> stretches = gap_free_rows(record);
  Spikes spikes;
  for (const Channel channel : kAllChannels) {
    std::vector<double>& values = values_of(record, channel);
    if (channel == Channel::kTime || values.empty()) continue;
    spikes.count[static_cast<std::size_t>(channel)] = mend(values, stretches);
  }
  return spikes;
}

}  // namespace steerid
