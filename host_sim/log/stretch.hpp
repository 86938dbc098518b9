// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One stretch of a record without a gap, and what reads it at other times: cubics, and the anti-alias filter.
#pragma once

#include <array>
#include <vector>

#include "log/anti_alias.hpp"
#include "log/log_format.hpp"
#include "log/record.hpp"
#include "log/record_quality.hpp"

namespace steerid {

inline constexpr double kSameStampS = 1e-9;  // stamps are microseconds; their sums round near 1e-12

/// All channels but the time, in the order of kAllChannels; empty where one is absent.
using ChannelValues = std::array<std::vector<double>, kChannels - 1>;

struct Stretch {
  std::vector<double> time_s{};
  ChannelValues values{};
};

[[nodiscard]] Stretch cut(const Record& record, GapFreeRows rows);

/// Behind the record's last row.
void append(Record& record, const Stretch& stretch);

/// The times origin + k period from `first_s` to `last_s`.
[[nodiscard]] std::vector<double> even_times(double origin_s, double first_s, double last_s, double period_s);

/// Mean of the intervals that are no holes (a lost sample doubles one): unlike the median it is exact however the
/// stamps are rounded. As much is left out below the median as above it: where a stamp is late, the interval before it
/// is too long by what the next one is too short.
[[nodiscard]] double mean_period_s(const std::vector<double>& time_s, double median_s);

/// True when every stamp lies on first + i * period: stamps that drift are not even although their intervals are.
[[nodiscard]] bool on_even_grid(const std::vector<double>& time_s, double period_s);

/// The source at `times_s`, all of them within it: the sample of a stamp, or Lagrange's cubic through the four nearest.
/// The source holds at least four samples.
[[nodiscard]] Stretch interpolated(const Stretch& source, std::vector<double> times_s);
[[nodiscard]] std::vector<double> interpolated(const std::vector<double>& time_s, const std::vector<double>& values,
                                               std::vector<double> at_s);

/// The stretch on an even grid of its own period.
[[nodiscard]] Stretch evened(Stretch stretch, double period_s);

/// The filter's output at `times_s`, each at least its half length from both ends of the source, which is even.
[[nodiscard]] Stretch filtered(const Stretch& source, double period_s, const AntiAlias& filter,
                               std::vector<double> times_s);

}  // namespace steerid
