#include "gap/held_out_split.hpp"

#include <algorithm>
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

std::vector<Block> held_out_split(const Record& record, double rate_hz) {
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
  for (const Cycle& cycle : cycles) {
    const std::size_t half = cycle.count / 2;
    const std::size_t quarter = cycle.count / 4;
    blocks.push_back({Block::Role::kFit, cycle.first, quick_length(half)});
    blocks.push_back({Block::Role::kChoose, cycle.first + half, quick_length(quarter)});
    blocks.push_back({Block::Role::kReport, cycle.first + half + quarter, quick_length(quarter)});
  }
  return blocks;
}

}  // namespace steerid
