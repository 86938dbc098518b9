// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which part of a record fits, which part chooses and which part reports. Fixed by the stamps alone, before anything
// is fitted.
//
// Every stretch between gaps is cut into cycles of about 20 s, at least two of 2.75 s, a cycle into three blocks: half
// of it fits, a quarter chooses among hypotheses, a quarter is held out and only reports. A shorter stretch of 0.69 s
// or more is a block by itself: of four such ones two fit, one chooses, one reports. Interleaving lets every part see
// the whole course of the record, so that a drift or a step in time is not met in one part only; the order of the three
// changes from cycle to cycle, so that what comes back every 20 s does not always meet the same.
#pragma once

#include <cstddef>
#include <vector>

#include "log/record.hpp"

namespace steerid::gap {

struct Block {
  enum class Role { kFit, kChoose, kReport } role = Role::kFit;
  std::size_t first = 0;
  std::size_t count = 0;  ///< a product of 2, 3 and 5, for a quick Fourier transform
};

inline constexpr double kCycle_s = 20.0;

/// The blocks of a record at 100 Hz, in order of time; empty when it lacks one of the three kinds (5.5 s in one
/// stretch have them, or four shorter ones). `turn`: the parts change places; what reported fits then, or chooses.
[[nodiscard]] std::vector<Block> held_out_split(const Record& record, std::size_t turn = 0);

}  // namespace steerid::gap
