// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Stamps of too few digits, so that rows share them: seconds with two digits of a log of 1 kHz, or days in single
// precision, which come in steps of 1/64 s.
//
// As a rule rows come by a steady clock, and a stamp is its time, rounded. Where a line through the stamps over the
// rows' numbers explains all of a stretch without a gap to within the step of the rounding, the rows are its: rows of
// 10 ms under stamps of 15.6 ms are 10 ms apart, not 7.8 and 15.6. Elsewhere rows that share a stamp are spread evenly
// up to the next one.
#pragma once

#include <cstddef>
#include <vector>

namespace steerid {

struct SharedStamps {
  std::size_t rows = 0;           ///< that shared the stamp of the one before
  std::size_t without_clock = 0;  ///< of these: no steady clock explains their stretch
};

/// Makes the stamps increase, s. They may not decrease, and do not where one stamp is all that there is, or where they
/// lie closer than a double tells.
SharedStamps spread_shared_stamps(std::vector<double>& time_s);

}  // namespace steerid
