// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/held_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "log/bad_input.hpp"
#include "log/stamp_limits.hpp"

namespace steerid {
namespace {

[[noreturn]] void complain_slow(double message_hz, std::string_view channel, const std::string& file) {
  throw bad_input({.file = file,
                   .expected = fmt::format("{} messages of {} a second or more", kLowestRateHz, channel),
                   .found = fmt::format("{:.4g}, and rows that repeat them", message_hz),
                   .advice = "have the sensor send faster"});
}

}  // namespace

std::optional<HeldRecord> HeldRecord::of(const Record& record, const std::string& file) {
  const std::vector<GapFreeRows> gap_free = gap_free_rows(record);
  if (gap_free.empty()) return std::nullopt;
  const GapFreeRows longest_rows = *std::ranges::max_element(gap_free, {}, &GapFreeRows::size);
  const MessageClocks longest = message_clocks(cut(record, longest_rows));
  if (std::ranges::none_of(longest, [](const auto& clock) { return clock.has_value(); })) return std::nullopt;
  HeldRecord out;
  out.first_s_ = record.time_s.front();
  out.row_s_ = quality_of(record).median_period_s;
  for (std::size_t c = 0; c < longest.size(); ++c) {
    if (!longest[c]) continue;
    out.message_hz_[c] = 1 / longest[c]->period_s;
    if (is_slow(*longest[c])) complain_slow(out.message_hz_[c], channel_name(kAllChannels[c + 1]), file);
  }
  for (const GapFreeRows rows : gap_free) {
    HeldStretch one{cut(record, rows), {}};
    one.clocks = rows.begin == longest_rows.begin ? longest : message_clocks(one.rows);
    const bool alike = std::ranges::equal(one.clocks, longest,
                                          [](const auto& a, const auto& b) { return a.has_value() == b.has_value(); });
    if (alike) out.stretches_.push_back(std::move(one));
    out.dropped_stretches_ += alike ? 0 : 1;
  }
  return out;
}

double HeldRecord::slowest_hz() const {
  double slowest_hz = std::numeric_limits<double>::infinity();
  for (const double hz : message_hz_) slowest_hz = hz > 0 ? std::min(slowest_hz, hz) : slowest_hz;
  return slowest_hz;
}

std::optional<Record> HeldRecord::messages_alone(Record empty) const {
  for (const HeldStretch& one : stretches_) {
    const std::optional<MessageClock> clock = clock_of_all(one.rows, one.clocks);
    if (!clock) return std::nullopt;
    append(empty, messages_of(one.rows, *clock));
  }
  return empty;
}

std::vector<Stretch> HeldRecord::filtered_messages(double period_s) const {
  std::vector<Stretch> out;
  for (const HeldStretch& one : stretches_) out.push_back(filtered_messages(one, period_s));
  return out;
}

Stretch HeldRecord::filtered_messages(const HeldStretch& one, double period_s) const {
  const AntiAlias filter = anti_alias_for(slowest_hz());
  const double row_s = mean_period_s(one.rows.time_s, row_s_);
  std::array<Stretch, kChannels - 1> source;
  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < source.size(); ++c) {
    if (one.rows.values[c].empty()) continue;
    Stretch all = one.clocks[c] ? messages_of(one.rows, *one.clocks[c]) : evened(one.rows, row_s);
    source[c].time_s = std::move(all.time_s);
    source[c].values[c] = std::move(all.values[c]);
    from_s = std::max(from_s, source[c].time_s.front() + filter.half_length_s);
    to_s = std::min(to_s, source[c].time_s.back() - filter.half_length_s);
  }
  Stretch out{even_times(first_s_, from_s, to_s, period_s), {}};
  for (std::size_t c = 0; c < source.size() && !out.time_s.empty(); ++c) {
    if (one.rows.values[c].empty()) continue;
    const double its_s = one.clocks[c] ? one.clocks[c]->period_s : row_s;
    out.values[c] = std::move(filtered(source[c], its_s, filter, out.time_s).values[c]);
  }
  return out;
}

}  // namespace steerid
