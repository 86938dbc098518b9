// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/frozen_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "log/channel_noise.hpp"

namespace steerid {
namespace {

constexpr double kFrozen_s = 0.5;
constexpr std::size_t kFewestRows = 20;

/// Marks the rows that repeat a frozen reading; says for how long.
double mark(const std::vector<double>& x, const std::vector<double>& time_s, std::vector<char>& frozen) {
  if (!(white_noise_deviation(x) > smallest_step(x))) return 0;
  const auto [smallest, largest] = std::ranges::minmax(x);
  double length_s = 0;
  for (std::size_t first = 0, next = 0; first < x.size(); first = next) {
    while (next < x.size() && x[next] == x[first]) ++next;
    const double held_s = time_s[next - 1] - time_s[first];
    const bool held_there = x[first] == smallest || x[first] == largest || x[first] == 0;
    if (next - first < kFewestRows || held_s < kFrozen_s || held_there) continue;
    std::fill(frozen.begin() + static_cast<std::ptrdiff_t>(first) + 1,
              frozen.begin() + static_cast<std::ptrdiff_t>(next), char{1});
    length_s += held_s;
  }
  return length_s;
}

}  // namespace

std::string FrozenChannels::note() const {
  std::string words;
  for (const Channel channel : kAllChannels) {
    const double held_s = length_s[static_cast<std::size_t>(channel)];
    if (held_s > 0) words += fmt::format("{}{} for {:.3g} s", words.empty() ? "" : ", ", channel_name(channel), held_s);
  }
  if (words.empty()) return words;
  return fmt::format("a sensor with noise repeated one reading to the last digit, {}: these rows were left out", words);
}

FrozenChannels leave_out_frozen(Record& record) {
  FrozenChannels out;
  std::vector<char> frozen(record.size(), 0);
  const std::uint8_t used = channels_of(record.equation());
  for (const Channel channel : kAllChannels) {
    const std::vector<double>& values = values_of(record, channel);
    if ((used & valid_bit(channel)) == 0 || values.empty()) continue;
    out.length_s[static_cast<std::size_t>(channel)] = mark(values, record.time_s, frozen);
  }
  if (std::ranges::find(frozen, char{1}) == frozen.end()) return out;
  for (const Channel channel : kAllChannels) {
    std::vector<double>& values = values_of(record, channel);
    if (values.empty()) continue;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (frozen[i] == 0) values[kept++] = values[i];
    }
    values.resize(kept);
  }
  return out;
}

}  // namespace steerid
