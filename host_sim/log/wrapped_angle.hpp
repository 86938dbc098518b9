// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An angle that begins anew after every turn, as an encoder's or a program's does that keeps it between 0 and 360 deg
// or between -180 and 180: its turns are counted through.
//
// It is one where all of its values lie within a turn, and from one to the next it goes either by less than a tenth of
// a turn or by more than nine tenths, which no wheel does between two rows; by the latter twice at least. Counted from
// the turn in which its mean is, as a record does not tell where a spring has its zero. Cost: two passes.
#pragma once

#include <cstddef>
#include <vector>

namespace steerid {

/// `angle_rad` with its turns counted through; values that are NaN stay so. How often it began anew: 0 where it does
/// not, and it is as it was.
std::size_t count_turns(std::vector<double>& angle_rad);

}  // namespace steerid
