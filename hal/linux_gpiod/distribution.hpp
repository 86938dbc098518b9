// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How long things took: counts in buckets of a quarter octave from 1 us on, so that a week of ticks fits in 1 KiB and a
// quantile is right within 9 % (half a bucket). Nothing allocates.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace steerid::linux_gpiod {

class Distribution {
 public:
  void add(std::int64_t duration_ns) {
    const std::int64_t us = std::max<std::int64_t>(duration_ns / 1000, 0);
    ++buckets_[bucket(static_cast<std::uint64_t>(us))];
    ++count_;
    largest_us_ = std::max(largest_us_, us);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t largest_us() const { return largest_us_; }
  /// The upper edge of the bucket that holds the quantile `part` (0 to 1), in us; 0 without data.
  [[nodiscard]] std::int64_t quantile_us(double part) const {
    const auto rank = static_cast<std::uint64_t>(part * static_cast<double>(count_));
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      below += buckets_[i];
      if (below > rank || (below == count_ && count_ > 0)) return std::min(upper_us(i), largest_us_);
    }
    return 0;
  }

 private:
  static constexpr std::size_t kBuckets = 128;  ///< 2^32 us

  /// 0 to 3 us each in their own bucket, then four buckets an octave.
  static std::size_t bucket(std::uint64_t us) {
    if (us < 4) return static_cast<std::size_t>(us);
    const int octave = static_cast<int>(std::bit_width(us)) - 1;
    const std::uint64_t quarter = (us >> static_cast<unsigned>(octave - 2)) & 3U;
    return std::min<std::size_t>(static_cast<std::size_t>(octave - 1) * 4 + quarter, kBuckets - 1);
  }
  static std::int64_t upper_us(std::size_t bucket) {
    if (bucket < 4) return static_cast<std::int64_t>(bucket);
    const std::size_t octave = bucket / 4 + 1;
    return ((std::int64_t{5} + static_cast<std::int64_t>(bucket % 4)) << (octave - 2)) - 1;
  }

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t largest_us_ = 0;
};

}  // namespace steerid::linux_gpiod
