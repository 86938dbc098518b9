// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Samples that nobody measured: a logger that is faster than its sensors fills in straight lines between their samples.
//
// What it fills in carries no noise of its own, and what it measured looks noisier beside it, so that no noise model
// fits the record; left out, the rest is the record as the sensors made it. Recognised is a whole number of rows for
// every measured one, the same for all channels and all through the record. With d_i = x_{i+1} - 2 x_i + x_{i-1}, which
// is zero on a straight line, the rows i with i mod n = r hold nearly all of sum d_i^2 of every channel that changes.
// White noise and smooth motion have it in every row alike, so that the share is 1 - 1/n there; a channel that is
// constant says nothing. Cost: a pass a channel, and one a channel and n where half of the rows lie on straight lines.
#pragma once

#include <cstddef>

#include "log/record.hpp"

namespace steerid {

struct MeasuredRows {
  std::size_t every = 1;  ///< one: all of them were measured
  std::size_t first = 0;  ///< the first of them
};

[[nodiscard]] MeasuredRows measured_rows(const Record& record);

/// The record with these rows alone.
[[nodiscard]] Record only(const Record& record, MeasuredRows rows);

}  // namespace steerid
