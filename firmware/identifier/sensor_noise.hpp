// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The white noise of a sensor, measured from its own signal while it works.
//
// The sixth difference of a signal that lives below 5 Hz is nothing but noise at 100 Hz sampling: a sine of frequency
// f comes through with (2 sin(pi f T))^6, 0.001 at 5 Hz, and white noise of variance s2 with 924 s2 (the sum of the
// squared binomial coefficients of order 6). Resolution shows up as the noise that it amounts to.
#pragma once

#include <cstdint>

namespace steerid {

template <class Scalar>
class SensorNoise {
 public:
  /// Not inlined: it is asked for twice a sample.
  [[gnu::noinline]] void push(Scalar x) {
    // Differences of rising order: each is the one below it minus what that was a sample ago.
    Scalar difference = x;
#pragma GCC unroll 6
    for (Scalar& before : last_) {
      const Scalar next = difference - before;
      before = difference;
      difference = next;
    }
    if (unusable_ > 0) {
      --unusable_;
      return;
    }
    if (samples_ < kMemory) ++samples_;
    Scalar power = difference * difference * Scalar(1.0 / 924.0);
    // A single wild sample must not look like a noisy sensor for the next ten seconds.
    if (samples_ > kTrusted && power > Scalar(25) * variance_) power = Scalar(25) * variance_;
    variance_ += (power - variance_) / Scalar(samples_);
    // A sensor that was faulty is not noisy for ten seconds more. A second's mean scatters by a quarter.
    lately_ += (power - lately_) * Scalar(1.0 / kTrusted);
    if (samples_ > kTrusted && lately_ * Scalar(kFallen) < variance_) {
      variance_ = lately_;
      samples_ = kTrusted;
    }
  }

  /// After a gap the next samples have no neighbours to be differenced with.
  void break_here() { unusable_ = kOrder; }

  [[nodiscard]] bool known() const { return samples_ > kTrusted; }
  [[nodiscard]] Scalar variance() const { return variance_; }

 private:
  static constexpr std::int16_t kOrder = 6;
  static constexpr std::int16_t kTrusted = 100;  ///< samples before the figure is used
  static constexpr std::int16_t kMemory = 1000;  ///< samples, ten seconds
  static constexpr double kFallen = 4;
  Scalar last_[kOrder] = {};
  Scalar variance_{0};
  Scalar lately_{0};
  std::int16_t samples_ = 0;
  std::int16_t unusable_ = kOrder;
};

}  // namespace steerid
