// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An angle that was stamped by another clock than the torques, read where theirs has it.
//
// What the wheel does at t stands in the angle's column at t + d (t - t0), d the drift. t0 is where a message slipped,
// as the clocks were in step there (log/slipped_messages.hpp); else the record's first stamp: two loggers begin
// together, and what is left of their offset is a delay as any other.
#pragma once

#include <optional>
#include <string>

#include "log/record.hpp"

namespace steerid {

/// The record, at 100 Hz, with the angle read by the torques' clock (log/read_between.hpp). `later_per_s`: d, by how
/// much later the angle comes every second; `in_step_s`: t0, if not the first stamp. Rows whose angle lies beyond a
/// stretch's ends are left out.
[[nodiscard]] Record by_one_clock(Record record, double later_per_s, const std::optional<double>& in_step_s);

/// A sentence for the user, on a record of that length.
[[nodiscard]] std::string clock_drift_words(double later_per_s, double length_s,
                                            const std::optional<double>& in_step_s);

}  // namespace steerid
