// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/held_out_split.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "log/record_quality.hpp"
#include "log/resample.hpp"

namespace steerid::gap {
namespace {

constexpr double kShortestCycle_s = 2.75;  // half of what the filter of a record of 60 Hz leaves of 6 s

/// The largest product of 2, 3 and 5 up to `count`.
std::size_t quick_length(std::size_t count) {
  for (; count > 1; --count) {
    std::size_t rest = count;
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) break;
  }
  return count;
}

}  // namespace

std::vector<Block> held_out_split(const Record& record, std::size_t turn) {
  constexpr std::array kRoles = {Block::Role::kFit, Block::Role::kChoose, Block::Role::kReport};
  constexpr std::array kShortRoles = {Block::Role::kFit, Block::Role::kChoose, Block::Role::kFit, Block::Role::kReport};
  std::vector<Block> blocks;
  std::size_t cycles = 0;
  std::size_t shorter = 0;
  for (const GapFreeRows& stretch : gap_free_rows(record)) {
    const double length_s = static_cast<double>(stretch.size()) / kResampledRateHz;
    if (length_s < kShortestCycle_s / 4) continue;
    const auto wanted = static_cast<std::size_t>(std::max(2.0, std::round(length_s / kCycle_s)));
    const std::size_t count = stretch.size() / wanted;
    if (static_cast<double>(count) / kResampledRateHz < kShortestCycle_s) {
      const Block::Role role = kShortRoles[(shorter++ + turn) % kShortRoles.size()];
      blocks.push_back({role, stretch.begin, quick_length(stretch.size())});
      continue;
    }
    for (std::size_t i = 0; i < wanted; ++i, ++cycles) {
      const std::size_t quarter = count / 4;
      std::size_t at = stretch.begin + i * count;
      for (std::size_t k = 0; k < kRoles.size(); ++k) {
        const Block::Role role = kRoles[(k + cycles + turn) % kRoles.size()];
        const std::size_t length = role == Block::Role::kFit ? count - 2 * quarter : quarter;
        blocks.push_back({role, at, quick_length(length)});
        at += length;
      }
    }
  }
  const auto is_there = [&](Block::Role role) { return std::ranges::find(blocks, role, &Block::role) != blocks.end(); };
  return std::ranges::all_of(kRoles, is_there) ? blocks : std::vector<Block>();
}

}  // namespace steerid::gap
