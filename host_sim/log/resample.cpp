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
#include "log/interpolated_samples.hpp"
#include "log/late_messages.hpp"
#include "log/log_format.hpp"
#include "log/log_reader.hpp"
#include "log/record_quality.hpp"
#include "log/sampling_instants.hpp"

namespace steerid {
namespace {

constexpr double kPeriodS = 1.0 / kResampledRateHz;
constexpr double kRateTolerance = 1e-3;      // a crystal is 20 times better, a host's sleep ten times worse
constexpr double kPassThroughJitter = 0.01;  // 0.1 ms of the wheel's fastest turning is a tenth of the angle's noise
constexpr double kEvenJitter = 1e-3;
constexpr double kSameStampS = 1e-9;  // stamps are microseconds; their sums round near 1e-12

using Values = std::array<std::vector<double>, kChannels - 1>;  // all but the time; empty where a channel is absent

/// One stretch between gaps.
struct Stretch {
  std::vector<double> time_s;
  Values values;
};

Stretch cut(const Record& record, GapFreeRows rows) {
  const auto part = [&](const std::vector<double>& column) {
    return std::vector<double>(column.begin() + static_cast<std::ptrdiff_t>(rows.begin),
                               column.begin() + static_cast<std::ptrdiff_t>(rows.end));
  };
  Stretch stretch{part(record.time_s), {}};
  for (std::size_t i = 0; i < stretch.values.size(); ++i) {
    const std::vector<double>& values = values_of(record, kAllChannels[i + 1]);
    if (!values.empty()) stretch.values[i] = part(values);
  }
  return stretch;
}

void append(Record& record, const Stretch& stretch) {
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(record.time_s, stretch.time_s);
  for (std::size_t i = 0; i < stretch.values.size(); ++i) {
    add(values_of(record, kAllChannels[i + 1]), stretch.values[i]);
  }
}

/// Mean of the intervals that are no holes (a lost sample doubles one): unlike the median it is exact however the
/// stamps are rounded. As much is left out below the median as above it: where a stamp is late, the interval before it
/// is too long by what the next one is too short.
double mean_period_s(const std::vector<double>& time_s, double median_s) {
  double sum_s = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double interval_s = time_s[i] - time_s[i - 1];
    if (std::abs(interval_s - median_s) > 0.5 * median_s) continue;
    sum_s += interval_s;
    ++count;
  }
  return count > 0 ? sum_s / static_cast<double>(count) : median_s;
}

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

/// True when every stamp lies on first + i * period: stamps that drift are not even although their intervals are.
bool on_even_grid(const std::vector<double>& time_s, double period_s) {
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double grid_s = time_s.front() + static_cast<double>(i) * period_s;
    if (std::abs(time_s[i] - grid_s) > kEvenJitter * period_s) return false;
  }
  return true;
}

/// Times first, first + period, ... up to last.
std::vector<double> grid(double origin_s, double first_s, double last_s, double period_s) {
  std::vector<double> times;
  const double from = std::ceil((first_s - origin_s - kSameStampS) / period_s);
  const double to = std::floor((last_s - origin_s + kSameStampS) / period_s);
  for (double k = from; k <= to; k += 1.0) times.push_back(origin_s + k * period_s);
  return times;
}

/// Lagrange's cubic through samples i .. i+3 at time t, for all channels.
void cubic(const Stretch& source, std::size_t i, double t, Stretch& out) {
  std::array<double, 4> weight{};
  for (std::size_t a = 0; a < 4; ++a) {
    weight[a] = 1.0;
    for (std::size_t b = 0; b < 4; ++b) {
      if (a == b) continue;
      weight[a] *= (t - source.time_s[i + b]) / (source.time_s[i + a] - source.time_s[i + b]);
    }
  }
  for (std::size_t channel = 0; channel < out.values.size(); ++channel) {
    if (source.values[channel].empty()) continue;
    double sum = 0.0;
    for (std::size_t a = 0; a < 4; ++a) sum += weight[a] * source.values[channel][i + a];
    out.values[channel].push_back(sum);
  }
}

/// The source at `times`, all of them within it; it holds at least four samples.
Stretch interpolated(const Stretch& source, std::vector<double> times) {
  Stretch out;
  out.time_s = std::move(times);
  std::size_t next = 1;  // source sample next - 1 is the last one not after t
  for (const double t : out.time_s) {
    while (next + 1 < source.time_s.size() && source.time_s[next] <= t) ++next;
    const std::size_t nearest = t - source.time_s[next - 1] < source.time_s[next] - t ? next - 1 : next;
    if (std::abs(source.time_s[nearest] - t) <= kSameStampS) {
      for (std::size_t c = 0; c < out.values.size(); ++c) {
        if (!source.values[c].empty()) out.values[c].push_back(source.values[c][nearest]);
      }
    } else {
      cubic(source, std::clamp<std::size_t>(next, 2, source.time_s.size() - 2) - 2, t, out);
    }
  }
  return out;
}

/// Filters the even stretch and reads it at `times`, each at least a half length from both ends.
Stretch filtered(const Stretch& source, double period_s, const AntiAlias& filter, std::vector<double> times) {
  static const AntiAliasKernel kernel;
  const double reach = filter.half_length_s / period_s;  // in source samples
  Stretch out;
  out.time_s = std::move(times);
  std::vector<double> weight;
  for (const double t : out.time_s) {
    const double centre = (t - source.time_s.front()) / period_s;
    const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(centre - reach)));
    const auto last = std::min(source.time_s.size() - 1, static_cast<std::size_t>(centre + reach));
    weight.clear();
    double scale = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      weight.push_back(kernel.at((centre - static_cast<double>(i)) / reach));
      scale += weight.back();
    }
    for (std::size_t channel = 0; channel < out.values.size(); ++channel) {
      if (source.values[channel].empty()) continue;
      const double* const value = source.values[channel].data() + first;
      double sum = 0.0;
      for (std::size_t k = 0; k < weight.size(); ++k) sum += weight[k] * value[k];
      out.values[channel].push_back(sum / scale);
    }
  }
  return out;
}

/// Every channel's messages in the rows of their own numbers (log/late_messages.hpp); those that no row shows by the
/// cubic. Rows beyond a channel's first or last message are left out.
void put_messages_in_place(Stretch& stretch, Resampled& all) {
  const std::size_t rows = stretch.time_s.size();
  std::array<std::optional<MessageNumbers>, kChannels - 1> messages;
  std::ptrdiff_t first = 0;
  auto last = static_cast<std::ptrdiff_t>(rows) - 1;
  for (std::size_t c = 0; c < messages.size(); ++c) {
    messages[c] = message_numbers(stretch.values[c]);
    if (!messages[c]) continue;
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
    values = steerid::interpolated(numbers, shown, at);
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
    return interpolated(stretch, grid(origin_s, stretch.time_s.front(), stretch.time_s.back(), kPeriodS));
  if (!on_even_grid(stretch.time_s, period_s)) {
    const double first_s = stretch.time_s.front();
    stretch = interpolated(stretch, grid(first_s, first_s, stretch.time_s.back(), period_s));
  }
  const AntiAlias filter = anti_alias_for(1.0 / period_s);
  std::vector<double> times = grid(origin_s, stretch.time_s.front() + filter.half_length_s,
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
  const Values channels = cut(record, {0, record.size()}).values;
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

}  // namespace

std::vector<double> interpolated(const std::vector<double>& time_s, const std::vector<double>& values,
                                 std::vector<double> at_s) {
  Stretch source{time_s, {}};
  source.values.front() = values;
  return interpolated(source, std::move(at_s)).values.front();
}

std::string Resampled::late_words() const {
  std::string words;
  for (std::size_t c = 0; c < late_share.size(); ++c) {
    if (!(late_share[c] > 0)) continue;
    words += fmt::format("{}{:.2g} % of the rows of {}", words.empty() ? "" : ", ", 100 * late_share[c],
                         channel_name(kAllChannels[c + 1]));
  }
  if (words.empty()) return words;
  return fmt::format("{} show an older message, as the logger keeps the last one that came: each is put in its own row",
                     words);
}

Resampled resample_100hz(const Record& log, const std::string& file) {
  Resampled result;
  result.record.channels = log.channels;
  result.record.motor_channel = log.motor_channel;
  std::optional<Record> mended = measured_alone(log);
  result.filled_in = mended.has_value();
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
  if (result.record.size() == 0) {
    if (in_bursts(log, result.dropped_stretches)) complain_bursts(log, result.dropped_stretches, file);
    throw bad_input({.file = file,
                     .expected = fmt::format("a stretch without gaps longer than the anti-alias filter's {:.2f} s",
                                             2.0 * anti_alias_for(1.0 / median_s).half_length_s),
                     .found = fmt::format("{} shorter ones", result.dropped_stretches),
                     .advice = "record without losing samples"});
  }
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
        grid(times.front(), times.front() - filter.half_length_s, times.back() + filter.half_length_s, period_s);
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
