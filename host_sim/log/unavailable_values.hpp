// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Numbers that stand for no measurement: a bus has no NaN, and sends the largest number that fits, 65535 or 32767 times
// the signal's scale (SAE J1939-71 calls it "not available"); loggers write -9999.
//
// Up to three neighbouring values at either end of a channel's range are such numbers where each stands in two rows at
// least (one is a spike, log/spikes.hpp) and they are farther from all others than
//
//   a torque    10 times the range of the others
//   an angle    2 times that, and half a turn: no wheel gets there from one row to the next
//
// and the others are a hundred different values: a command of a few levels may have one that is far from the rest. The
// factors are set by hand: a signal uses a tenth of what its bits hold, or less, unless it is scaled to what it reads.
//
// Cost: a pass a column, and a sort of one that has a value that is far from most.
#pragma once

#include <cstddef>
#include <vector>

#include "log/log_format.hpp"

namespace steerid {

struct UnavailableValues {
  std::vector<double> value{};  ///< SI units
  std::size_t rows = 0;
};

/// Puts NaN in their place. Values that are NaN already are passed over.
UnavailableValues leave_out_unavailable(std::vector<double>& values, Channel channel);

}  // namespace steerid
