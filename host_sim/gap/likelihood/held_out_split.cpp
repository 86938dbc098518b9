// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/held_out_split.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "log/record_quality.hpp"

namespace steerid {
namespace {

constexpr double kShortestCycle_s = 3.0;

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

std::vector<Block> held_out_split(const Record& record, double rate_hz, std::size_t turn) {
  struct Cycle {
    std::size_t first, count;
  };
  std::vector<Cycle> cycles;
  for (const GapFreeRows& stretch : gap_free_rows(record)) {
    const double length_s = static_cast<double>(stretch.size()) / rate_hz;
    const auto wanted = static_cast<std::size_t>(std::max(2.0, std::round(length_s / kCycle_s)));
    const std::size_t count = stretch.size() / wanted;
    if (static_cast<double>(count) / rate_hz < kShortestCycle_s) continue;
    for (std::size_t i = 0; i < wanted; ++i) cycles.push_back({stretch.begin + i * count, count});
  }
  std::vector<Block> blocks;
  constexpr std::array kRoles = {Block::Role::kFit, Block::Role::kChoose, Block::Role::kReport};
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const Cycle& cycle = cycles[i];
    const std::size_t quarter = cycle.count / 4;
    std::size_t at = cycle.first;
    for (std::size_t k = 0; k < kRoles.size(); ++k) {
      const Block::Role role = kRoles[(k + i + turn) % kRoles.size()];
      const std::size_t length = role == Block::Role::kFit ? cycle.count - 2 * quarter : quarter;
      blocks.push_back({role, at, quick_length(length)});
      at += length;
    }
  }
  return blocks;
}

}  // namespace steerid
