// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "log/bad_input.hpp"
#include "log/held_record.hpp"
#include "log/interpolated_samples.hpp"
#include "log/late_messages.hpp"
#include "log/log_format.hpp"
#include "log/log_reader.hpp"
#include "log/record_quality.hpp"
#include "log/sampling_instants.hpp"
#include "log/slipped_messages.hpp"
#include "log/stretch.hpp"

namespace steerid {
namespace {

constexpr double kPeriodS = 1.0 / kResampledRateHz;
constexpr double kRateTolerance = 1e-3;      // a crystal is 20 times better, a host's sleep ten times worse
constexpr double kPassThroughJitter = 0.01;  // 0.1 ms of the wheel's fastest turning is a tenth of the angle's noise

bool near_100hz(double period_s) { return std::abs(period_s - kPeriodS) <= kRateTolerance * kPeriodS; }

bool intervals_within(const std::vector<double>& time_s, double period_s, double share) {
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (std::abs(time_s[i] - time_s[i - 1] - period_s) > share * period_s) return false;
  }
  return true;
}

bool passes_through(const std::vector<double>& time_s, double period_s) {
  return near_100hz(period_s) && intervals_within(time_s, period_s, kPassThroughJitter);
}

/// Every channel's messages in the rows of their own numbers (log/late_messages.hpp, log/slipped_messages.hpp); those
/// that no row shows by the cubic. Rows beyond a channel's first or last message are left out.
void put_messages_in_place(Stretch& stretch, Resampled& all) {
  const std::size_t rows = stretch.time_s.size();
  std::array<std::optional<MessageNumbers>, kChannels - 1> messages;
  std::ptrdiff_t first = 0;
  auto last = static_cast<std::ptrdiff_t>(rows) - 1;
  for (std::size_t c = 0; c < messages.size(); ++c) {
    messages[c] = message_numbers(stretch.values[c]);
    if (!messages[c]) messages[c] = slipped_numbers(stretch.values[c], kAllChannels[c + 1] == Channel::kAngle);
    if (!messages[c]) continue;
    for (const std::size_t row : messages[c]->slips) all.slips_s[c].push_back(stretch.time_s[row]);
    first = std::max(first, messages[c]->number.front());
    last = std::min(last, messages[c]->number.back());
    all.late_share[c] = std::max(all.late_share[c], messages[c]->late_share);
  }
  if (std::ranges::none_of(messages, [](const auto& one) { return one.has_value(); }) || last < first) return;
  all.untouched = false;
  std::vector<double> at;
  for (std::ptrdiff_t i = first; i <= last; ++i) at.push_back(static_cast<double>(i));
  const auto kept = [&](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + first, values.begin() + last + 1);
  };
  for (std::size_t c = 0; c < messages.size(); ++c) {
    std::vector<double>& values = stretch.values[c];
    if (values.empty()) continue;
    if (!messages[c]) {
      values = kept(values);
      continue;
    }
    std::vector<double> numbers(messages[c]->number.begin(), messages[c]->number.end());
    std::vector<double> shown;
    for (const std::size_t row : messages[c]->row) shown.push_back(values[row]);
    values = interpolated(numbers, shown, at);
  }
  stretch.time_s = kept(stretch.time_s);
}

/// One stretch brought to 100 Hz on the grid of `origin_s`; empty when it is too short. Tells `all` what was done.
Stretch resample_stretch(Stretch stretch, double period_s, double origin_s, Resampled& all) {
  constexpr std::size_t kFewestForCubic = 4;
  const bool passes = passes_through(stretch.time_s, period_s);
  if (passes || on_even_grid(stretch.time_s, period_s)) put_messages_in_place(stretch, all);
  if (passes) return stretch;
  all.untouched = false;
  if (stretch.time_s.size() < kFewestForCubic) return {};
  if (near_100hz(period_s))
    return interpolated(stretch, even_times(origin_s, stretch.time_s.front(), stretch.time_s.back(), kPeriodS));
  stretch = evened(std::move(stretch), period_s);
  const AntiAlias filter = anti_alias_for(1.0 / period_s);
  std::vector<double> times = even_times(origin_s, stretch.time_s.front() + filter.half_length_s,
                                         stretch.time_s.back() - filter.half_length_s, kPeriodS);
  if (times.empty()) return {};
  all.filtered = true;
  return filtered(stretch, period_s, filter, std::move(times));
}

/// Without the samples that its logger filled in, as long as the rest is fast enough to be a record.
std::optional<Record> measured_alone(const Record& record) {
  const MeasuredRows rows = measured_rows(record);
  const double rate_hz = 1.0 / (quality_of(record).median_period_s * static_cast<double>(rows.every));
  if (rows.every == 1 || rate_hz < 0.99 * kLowestRateHz) return std::nullopt;
  return only(record, rows);
}

void append_filtered_messages(const HeldRecord& held, Resampled& all) {
  all.source_rate_hz = held.slowest_hz();
  all.filtered = true;
  all.untouched = false;
  for (const Stretch& done : held.filtered_messages(kPeriodS)) {
    all.dropped_stretches += done.time_s.empty() ? 1 : 0;
    append(all.record, done);
  }
}

/// The stamps of an even grid where the samples are even and the stamps are not.
std::optional<std::vector<double>> straightened_stamps(const Record& record) {
  const double median_s = quality_of(record).median_period_s;
  const bool even = std::ranges::all_of(gap_free_rows(record), [&](GapFreeRows rows) {
    const std::vector<double> time_s = cut(record, rows).time_s;
    const double period_s = mean_period_s(time_s, median_s);
    return on_even_grid(time_s, period_s) || passes_through(time_s, period_s);
  });
  if (even) return std::nullopt;
  const double period_s = clock_period_s(record.time_s, mean_period_s(record.time_s, median_s));
  const ChannelValues channels = cut(record, {0, record.size()}).values;
  if (!evenly_sampled(record.time_s, period_s, channels)) return std::nullopt;
  return even_stamps(record.time_s, period_s, channels);
}

/// Rows that a logger wrote in bursts, as they came over the network: often enough on the whole, but stamped with the
/// time of the writing.
bool in_bursts(const Record& record, std::size_t bursts) {
  constexpr double kSlowestHz = 50;
  const double length_s = record.time_s.back() - record.time_s.front();
  return bursts > 2 && record.size() > 3 * bursts && static_cast<double>(record.size()) > kSlowestHz * length_s;
}

[[noreturn]] void complain_bursts(const Record& record, std::size_t bursts, const std::string& file) {
  const auto count = static_cast<double>(bursts);
  const double length_s = record.time_s.back() - record.time_s.front();
  throw bad_input({.file = file,
                   .expected = "the time at which each row was measured",
                   .found = fmt::format("{} bursts of {:.0f} rows {:.3g} ms apart, one every {:.3g} s", bursts,
                                        static_cast<double>(record.size()) / count,
                                        1e3 * quality_of(record).median_period_s, length_s / (count - 1)),
                   .advice = "log the sender's own stamps; or, if it measures evenly, give all rows of a burst one "
                             "stamp: they are spread evenly then"});
}

[[noreturn]] void complain_too_short(const Record& log, const Resampled& result, const std::string& file) {
  if (in_bursts(log, result.dropped_stretches)) complain_bursts(log, result.dropped_stretches, file);
  const double rate_hz = 1.0 / quality_of(log).median_period_s;
  throw bad_input({.file = file,
                   .expected = fmt::format("a stretch without gaps longer than the anti-alias filter's {:.2f} s",
                                           2.0 * anti_alias_for(rate_hz).half_length_s),
                   .found = fmt::format("{} shorter ones", result.dropped_stretches),
                   .advice = "record without losing samples"});
}

}  // namespace

std::vector<std::string> Resampled::notes() const {
  std::vector<std::string> all;
  if (filled_in) {
    all.emplace_back(
        "the logger filled in straight lines between the measured samples: only what was measured is looked at");
  }
  if (restamped) {
    all.emplace_back(
        "the samples are even and their stamps are not: taken as stamped late, on arrival, and put on an even grid");
  }
  const auto by_channel = [](const auto& of_channel, const char* words, double times) {
    std::vector<std::string> each;
    for (std::size_t c = 0; c < of_channel.size(); ++c) {
      if (!(of_channel[c] > 0)) continue;
      each.push_back(fmt::format(fmt::runtime(words), times * of_channel[c], channel_name(kAllChannels[c + 1])));
    }
    return fmt::format("{}", fmt::join(each, ", "));
  };
  if (const std::string words = by_channel(message_hz, "{1} comes {0:.4g} times a second", 1); !words.empty()) {
    all.push_back(fmt::format(
        "{}, and the rows between repeat it: each is read when its messages came, which is known to {:.2g} ms", words,
        1e3 * message_told_to_s));
  }
  for (std::size_t c = 0; c < slips_s.size(); ++c) {
    if (slips_s[c].empty()) continue;
    all.push_back(
        fmt::format("{} repeats or skips a message at {:.6g} s, as its clock is not the logger's: its messages "
                    "are counted through",
                    channel_name(kAllChannels[c + 1]), fmt::join(slips_s[c], ", ")));
  }
  if (const std::string words = by_channel(late_share, "{:.2g} % of the rows of {}", 100); !words.empty()) {
    all.push_back(words +
                  " show an older message, as the logger keeps the last one that came: each is put in its own row");
  }
  return all;
}

std::optional<double> Resampled::in_step_s() const {
  std::optional<double> all;
  for (const std::vector<double>& slips : slips_s) {
    if (slips.empty()) continue;
    if (all && *all != slips.front()) return std::nullopt;
    all = slips.front();
  }
  return all;
}

Resampled resample_100hz(const Record& log, const std::string& file) {
  Resampled result;
  result.record.channels = log.channels;
  result.record.motor_channel = log.motor_channel;
  std::optional<Record> mended = measured_alone(log);
  result.filled_in = mended.has_value();
  if (const auto held = mended ? std::nullopt : HeldRecord::of(log, file)) {
    result.message_hz = held->message_hz();
    result.message_told_to_s = held->row_s();
    result.dropped_stretches = held->dropped_stretches();
    mended = held->messages_alone(result.record);
    if (!mended) {
      append_filtered_messages(*held, result);
      if (result.record.size() == 0) complain_too_short(log, result, file);
      return result;
    }
  }
  if (auto stamps = straightened_stamps(mended ? *mended : log)) {
    result.restamped = true;
    if (!mended) mended = log;
    mended->time_s = std::move(*stamps);
  }
  const Record& record = mended ? *mended : log;
  result.untouched = !mended;
  const double median_s = quality_of(record).median_period_s;
  for (const GapFreeRows rows : gap_free_rows(record)) {
    Stretch stretch = cut(record, rows);
    const double period_s = mean_period_s(stretch.time_s, median_s);
    const Stretch done = resample_stretch(std::move(stretch), period_s, record.time_s.front(), result);
    if (done.time_s.empty()) {
      ++result.dropped_stretches;
      continue;
    }
    if (result.record.size() == 0) result.source_rate_hz = 1.0 / period_s;
    append(result.record, done);
  }
  if (result.record.size() == 0) complain_too_short(log, result, file);
  return result;
}

std::vector<double> resampled_white_noise(const Resampled& resampled) {
  // Any signs will do: what is asked of them are means over the record.
  std::mt19937_64 bits(1);  // NOLINT(cert-msc32-c,cert-msc51-cpp)
  const auto white = [&bits](std::size_t count) {
    std::vector<double> noise(count);
    for (double& value : noise) value = (bits() & 1U) != 0 ? 1.0 : -1.0;
    return noise;
  };
  if (!resampled.filtered) return white(resampled.record.size());
  const double period_s = 1.0 / resampled.source_rate_hz;
  const AntiAlias filter = anti_alias_for(resampled.source_rate_hz);
  std::vector<double> out;
  for (const GapFreeRows rows : gap_free_rows(resampled.record)) {
    std::vector<double> times = cut(resampled.record, rows).time_s;
    Stretch source;
    source.time_s =
        even_times(times.front(), times.front() - filter.half_length_s, times.back() + filter.half_length_s, period_s);
    source.values.front() = white(source.time_s.size());
    const std::vector<double> noise = filtered(source, period_s, filter, std::move(times)).values.front();
    out.insert(out.end(), noise.begin(), noise.end());
  }
  return out;
}

std::vector<double> filtered_alike(const Resampled& resampled, std::vector<double> values) {
  if (!resampled.filtered) return values;
  Stretch source;
  for (std::size_t i = 0; i < values.size(); ++i) source.time_s.push_back(static_cast<double>(i) * kPeriodS);
  source.values.front() = std::move(values);
  return filtered(source, kPeriodS, anti_alias_for(resampled.source_rate_hz), source.time_s).values.front();
}

}  // namespace steerid
