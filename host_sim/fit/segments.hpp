// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A record cut where samples are missing. A free run cannot know where the wheel went during a gap, so it restarts
// after it with an initial angle and rate of its own, and the torque is not interpolated across it.
//
// Samples with a channel that is not finite are left out first. A hole of up to two samples is bridged by the torque's
// spline (its error grows with the fourth power of the spacing: still below 0.2 % at 5 Hz); a longer one is a gap.
// Pieces too short to say anything beyond their own initial state are left out.
#pragma once

#include <cstddef>
#include <vector>

#include "log/record.hpp"
#include "plant/torque_signal.hpp"

namespace steerid {

struct Segment {
  std::vector<std::size_t> sample;  ///< index in the record of each sample used
  std::vector<double> time_s;
  std::vector<double> angle_rad;
  std::vector<double> net_torque_nm;
  TorqueSignal torque;

  [[nodiscard]] std::size_t size() const { return time_s.size(); }
};

/// Fewest samples a segment may have.
inline constexpr std::size_t kShortestSegment = 20;

/// The median time between samples, in seconds; 0 for fewer than two samples.
double sample_period_s(const Record& record);

/// The gap-free segments of a record, in order.
std::vector<Segment> gap_free_segments(const Record& record, TorqueSignal::Between between);

}  // namespace steerid
