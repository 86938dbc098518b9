// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Slow torque as the identifier's colour model has it (identifier/noise_colour.hpp): white noise behind two first-order
// lags in a row at 0.3 Hz, at 100 samples a second.
#pragma once

#include <cmath>
#include <numbers>

namespace steerid::test {

class TwoLags {
 public:
  /// `rms` of what comes out when white noise of variance 1 goes in.
  explicit TwoLags(double rms)  // two lags fed with variance 1 have (1 - a)^4 (1 + a^2) / (1 - a^2)^3
      : gain_(rms / std::sqrt(std::pow(1 - kKeep, 4) * (1 + kKeep * kKeep) / std::pow(1 - kKeep * kKeep, 3))) {}

  double operator()(double white) {
    once_ = kKeep * once_ + (1 - kKeep) * gain_ * white;
    twice_ = kKeep * twice_ + (1 - kKeep) * once_;
    return twice_;
  }

 private:
  static inline const double kKeep = std::exp(-2 * std::numbers::pi * 0.3 * 0.01);

  double gain_;
  double once_ = 0;
  double twice_ = 0;
};

}  // namespace steerid::test
