// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Columns with stamps of their own, brought to rows of one clock.
//
//   1. Rows that lack a value are left out, unless more values would be lost with them than kept: then the columns were
//      merged from several clocks, and each is taken by its own stamps.
//   2. Samples that share a stamp: equal ones are one sample, written twice; others were stamped with too few digits,
//      and are spread evenly up to the next stamp.
//   3. Of several clocks the fastest counts. The others' values at its stamps come from the cubic through their four
//      nearest samples, whole ones beside their gaps too (log/record_quality.hpp); in a gap, and outside of what a
//      clock has recorded, there is no row.
//
// Nothing is filtered here: that is the resampling's (log/resample.hpp).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "log/log_source.hpp"

namespace steerid {

struct OneClock {
  std::vector<double> time_s{};               ///< strictly increasing
  std::vector<std::vector<double>> values{};  ///< for each column, in the order of `wanted`
  std::size_t left_out = 0;                   ///< rows that lack a value or a stamp
  std::size_t first_incomplete_line = 0;      ///< 0: none, or no lines
  std::vector<std::string> notes{};
};

/// `groups` hold `columns` columns in all, each once. Throws BadInput, naming `name`, when clocks do not overlap.
[[nodiscard]] OneClock one_clock(std::vector<StampedColumns> groups, std::size_t columns, const std::string& name);

}  // namespace steerid
