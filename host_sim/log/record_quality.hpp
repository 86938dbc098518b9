// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How good a record's time axis is: rate, jitter, gaps, and the stretches between the gaps.
//
// A gap is longer than 2.5 median periods and than 10 ms, and than 4.5 of them or 45 ms, whichever is shorter: at 100
// Hz three samples lost in a row are coasted over, at 50 Hz one. A cubic through the samples around a hole of 10 ms of
// a fast log is within 2e-4 of a sine of 5 Hz, and has 2.5 times the noise of a sample at 1 kHz; within one of 40 ms it
// is within 6 %, and of 100 Hz with one row in five lost at random 2 % of the rows are in such. Split at two lost
// samples, such a record was in pieces of a second, of which neither noise nor effects can be told. Cost: one pass and
// a selection, with one more column of doubles held meanwhile.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "log/log_format.hpp"
#include "log/record.hpp"

namespace steerid {

/// A longer interval is a gap.
[[nodiscard]] constexpr double longest_interval_s(double median_period_s) {
  constexpr double kPeriods = 2.5;
  constexpr double kMostPeriods = 4.5;
  constexpr double kOfFastLogs_s = 0.010001;  // stamps are microseconds
  constexpr double kOfSlowLogs_s = 0.045;
  return std::max({kPeriods * median_period_s, kOfFastLogs_s, std::min(kMostPeriods * median_period_s, kOfSlowLogs_s)});
}

struct Gap {
  double start_s = 0.0;   ///< stamp of the last sample before it
  double length_s = 0.0;  ///< to the first sample after it
};

/// Where a channel was read from.
struct ReadChannel {
  std::string column{};         ///< as --columns names it; empty without one
  bool unit_by_option = false;  ///< the user has stated it, after a colon in --columns
  bool whole_numbers = false;   ///< all of its values, in SI: as counts are that were taken for it
  std::size_t file = 0;
};

struct RecordQuality {
  std::size_t rows = 0;          ///< samples in the record
  std::size_t dropped_rows = 0;  ///< rows of the file with an empty or NaN cell, not in the record
  double median_period_s = 0.0;  ///< 0 with fewer than two samples
  double jitter_s = 0.0;         ///< 95th percentile of |interval - median period|, gaps left out
  std::vector<Gap> gaps{};
  bool slide = false;  ///< stated to be in metres or newtons: a linear drive
  std::array<ReadChannel, kChannels> channels{};
  std::vector<double> moved_s{};     ///< for each file, what was added to its stamps
  std::vector<std::string> notes{};  ///< whole sentences for the user: units taken for granted, channels taken as zero

  [[nodiscard]] const ReadChannel& channel(Channel which) const { return channels[static_cast<std::size_t>(which)]; }
};

/// Samples [begin, end) of a record, without a gap between them.
struct GapFreeRows {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Everything that the record itself shows; dropped_rows, slide, channels, moved_s and notes are the reader's to fill.
[[nodiscard]] RecordQuality quality_of(const Record& record);

/// The stretches between the gaps, in order; together they hold every sample once.
[[nodiscard]] std::vector<GapFreeRows> gap_free_rows(const Record& record);

}  // namespace steerid
