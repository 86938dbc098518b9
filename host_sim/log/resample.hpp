// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A record of any rate, jittered or not, brought to 100 Hz without inventing a delay.
//
// First of all the samples that a logger filled in are left out (log/interpolated_samples.hpp), and stamps that stray
// while the samples are even are straightened (log/sampling_instants.hpp); of channels that rows repeat the messages
// alone are looked at (log/held_messages.hpp), and messages that came late are put in their own rows
// (log/late_messages.hpp, log/slipped_messages.hpp). Then each stretch between gaps goes its own way:
//   1. Already at 100 Hz (mean period within 0.1 % of 10 ms, every interval within 1 %): passes through bit for bit.
//   2. Stamps that stray from an even grid by more than 0.1 % of a period (1 % in case 1), or single lost samples: put
//      on an even grid of the stretch's own rate by cubic interpolation through the four nearest samples. A grid point
//      that falls on a stamp takes that sample as it is. When that rate is 100 Hz (within 0.1 %) this is all.
//   3. Filtered and resampled in one (log/anti_alias.hpp); so are channels whose messages came by several clocks, each
//      from its own, by the filter for the slowest.
//
// The filter needs half its length on both sides, so each stretch loses that much at both ends: shrink, not invent.
// The new stamps are whole multiples of 10 ms after the record's first stamp. Cost: 0.3 us a row of 1 kHz.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "log/anti_alias.hpp"
#include "log/log_format.hpp"
#include "log/record.hpp"

namespace steerid {

struct Resampled {
  Record record{};
  double source_rate_hz = 0.0;  ///< of the first stretch that was kept
  bool filtered = false;        ///< some stretch went through the filter
  bool untouched = true;        ///< every stretch passed through bit for bit
  bool restamped = false;       ///< it was sampled evenly, whatever its stamps say
  bool filled_in = false;       ///< samples that the logger interpolated were left out
  /// Of each channel but the time, how often a message of it came, where the rows between repeat it
  /// (log/held_messages.hpp); else 0.
  std::array<double, kChannels - 1> message_hz{};
  double message_told_to_s = 0;  ///< between two rows of the log: a message may have come so much earlier
  /// And the share of rows that showed an older message (log/late_messages.hpp).
  std::array<double, kChannels - 1> late_share{};
  /// And the stamps at which it slipped by one (log/slipped_messages.hpp).
  std::array<std::vector<double>, kChannels - 1> slips_s{};
  /// The stamp at which the clock that slips was in step with the others'; nothing where none slips, or two do.
  [[nodiscard]] std::optional<double> in_step_s() const;
  std::size_t dropped_stretches = 0;  ///< too short for the filter, for the cubic, or to tell its messages
  /// What of this was done, whole sentences for the user.
  [[nodiscard]] std::vector<std::string> notes() const;
};

/// What has `values` at `time_s`, strictly increasing and four at least, at the times `at_s` within these: the value of
/// the stamp, or the cubic through the four nearest.
[[nodiscard]] std::vector<double> interpolated(const std::vector<double>& time_s, const std::vector<double>& values,
                                               std::vector<double> at_s);

/// Throws BadInput, about `file`, when no stretch is long enough.
[[nodiscard]] Resampled resample_100hz(const Record& record, const std::string& file = "");

/// White noise of variance 1 at the log's own rate, as it comes through what was done to the log: a value a sample of
/// `resampled.record`. The same at every call.
[[nodiscard]] std::vector<double> resampled_white_noise(const Resampled& resampled);

/// What the log's filter lets through of `values`, one every 10 ms without a gap: what is worked out from a resampled
/// record may be faster than anything in it.
[[nodiscard]] std::vector<double> filtered_alike(const Resampled& resampled, std::vector<double> values);

}  // namespace steerid
