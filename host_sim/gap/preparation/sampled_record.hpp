// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A record short enough to be looked at closely.
//
// What ten minutes do not tell, hours do not tell either, and every fit goes over the whole record again and again. A
// record of more than kLongest_s of gap-free stretches is therefore cut into pieces of some kPiece_s, of which as many
// as make kLongest_s are kept, spread evenly over the whole course, so that what creeps or comes and goes is still met.
// Stamps stay as they are: between the pieces the record has gaps.
#pragma once

#include "gap/likelihood/held_out_split.hpp"
#include "log/record.hpp"

namespace steerid::gap {

inline constexpr double kLongest_s = 600.0;
inline constexpr double kPiece_s = 2 * kCycle_s;

/// The record itself when it is short enough.
[[nodiscard]] Record sampled_record(Record record);

}  // namespace steerid::gap
