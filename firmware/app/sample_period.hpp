// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How far apart the samples are, by their stamps.
//
// The identifier counts time in samples and takes one for 10 ms. From samples that are h apart it finds, of the same
// wheel, J (10 ms / h)^2, B 10 ms / h and C: the derivatives are so many times too large. So the task measures h and
// multiplies by its powers what it publishes; filters and memories are as much faster or slower, which costs accuracy,
// not truth. What was learned at another h is of another unit, and is forgotten.
//
// h is the mean over a block of kBlock samples, bridged ones included. One that is within kSame of the nominal 10 ms is
// the nominal: clocks of the sender are good to 0.01 %, and 1 % of h is 2 % of J, a fifth of what counts as wrong.
// Stamps that jitter by 2 ms about a grid move the mean of a block by 0.2 %, periods that do by 1 %: what the range of
// the block's periods allows for is added. Another h is taken once two blocks in a row agree on it: 2.6 s of samples 10
// ms apart, before which nothing can be valid after a start.
//
// Samples less than 5 ms apart are turned down for repetitions (input_supervision.hpp), and those 15 ms apart and more
// are bridged: what is left is 5 to 15 ms apart, whatever comes.
#pragma once

#include <cstdint>

#include "port/sample.hpp"

namespace steerid {

class SamplePeriod {
 public:
  /// A sample `elapsed_us` after the last one, at most a second, that counts for `periods` of the identifier's samples,
  /// at least 1. True when the period is found to be another one than it was taken for.
  bool take(std::int64_t elapsed_us, int periods) {
    if (samples_ == 0) shortest_us_ = longest_us_ = kNominal_us;
    if (periods == 1) {
      const auto now_us = static_cast<std::uint16_t>(elapsed_us);
      if (samples_ == 0 || now_us < shortest_us_) shortest_us_ = now_us;
      if (samples_ == 0 || now_us > longest_us_) longest_us_ = now_us;
    }
    elapsed_us_ += static_cast<std::int32_t>(elapsed_us);
    samples_ = static_cast<std::int16_t>(samples_ + periods);
    if (samples_ < kBlock) return false;
    auto found_us = static_cast<std::uint16_t>((elapsed_us_ + samples_ / 2) / samples_);
    const std::int32_t by_chance_us = (longest_us_ - shortest_us_) / kOfRange;
    if (same(found_us, kNominal_us, by_chance_us)) found_us = kNominal_us;
    // Bridged samples make the mean longer, never shorter.
    const bool is_a_rate = found_us < kNominal_us || by_chance_us < kNominal_us / 16;
    const bool agreed = is_a_rate && same(found_us, last_us_, by_chance_us);
    last_us_ = found_us;
    elapsed_us_ = 0;
    samples_ = 0;
    if (!agreed || same(found_us, period_us_, by_chance_us)) return false;
    period_us_ = found_us;
    return true;
  }
  /// The next sample does not follow the last one.
  void break_here() {
    elapsed_us_ = 0;
    samples_ = 0;
  }

  [[nodiscard]] std::int32_t period_us() const { return period_us_; }
  /// What the identifier found in samples of 10 ms, in seconds: its J to the power 2, its B to 1, its C to 0.
  template <class Scalar>
  [[nodiscard]] Scalar in_seconds(Scalar found, int power) const {
    if (period_us_ == kNominal_us) return found;
    const Scalar ratio = Scalar(std::int32_t{period_us_}) * Scalar(1.0 / kTickPeriodUs);
    for (int i = 0; i < power; ++i) found = found * ratio;
    return found;
  }

 private:
  static constexpr std::uint16_t kNominal_us = kTickPeriodUs;
  static constexpr std::int16_t kBlock = 128;
  static constexpr std::int32_t kSame = 100;  ///< one part in so many
  static constexpr std::int32_t kOfRange =
      8;  ///< five deviations of the mean of kBlock periods that are even within it
  [[nodiscard, gnu::noinline]] static bool same(std::int32_t a, std::int32_t b, std::int32_t by_chance) {
    const std::int32_t apart = a > b ? a - b : b - a;
    return (apart - by_chance) * kSame < b;
  }

  std::int32_t elapsed_us_ = 0;
  std::uint16_t period_us_ = kNominal_us;
  std::uint16_t last_us_ = kNominal_us;  ///< of the block before
  std::uint16_t shortest_us_ = 0, longest_us_ = 0;
  std::int16_t samples_ = 0;
};

}  // namespace steerid
