// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An angle that was stamped by another clock than the torques, read where theirs has it.
//
// What the wheel does at t stands in the angle's column at t + tau + d (t - t0), d the drift. t0 is where a message
// slipped, as the clocks were in step there (log/slipped_messages.hpp); else the record's first stamp: two loggers
// begin together, and what is left of their offset is a delay as any other. tau is the logger's where rows hold
// channels: they tell the time of a message to a row (log/held_messages.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "log/record.hpp"

namespace steerid {

/// Of the angle, against that of the torques.
struct AngleClock {
  double late_s = 0;       ///< tau: the angle comes later by this
  double later_per_s = 0;  ///< d: and by so much more every second

  [[nodiscard]] bool is_the_torques() const { return late_s == 0 && later_per_s == 0; }
};

/// The record, at 100 Hz, with the angle read by the torques' clock (log/read_between.hpp). `in_step_s`: t0, if not the
/// first stamp. Rows whose angle lies beyond a stretch's ends are left out.
[[nodiscard]] Record by_one_clock(Record record, const AngleClock& clock, const std::optional<double>& in_step_s);

/// Sentences for the user, on a record of that length.
[[nodiscard]] std::vector<std::string> clock_notes(const AngleClock& clock, double length_s,
                                                   const std::optional<double>& in_step_s);

}  // namespace steerid
