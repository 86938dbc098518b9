// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The triangle wave of the passive task, with its corners rounded over 0.1 s so that it has no jump in its slope.
//
// Straight at 4 A/P per second; within 0.05 s of a turning point a parabola with the same slope at both ends, which
// lowers the peak by A 4/P 0.025 s: 0.25 % of the amplitude for the paper's period of 40 s. Its harmonics beyond 10 Hz
// stay below 1e-5 of the amplitude. Starts at 0, rising.
#pragma once

#include <cstdint>

#include "experiment/signal_point.hpp"

namespace steerid {

class Triangle {
 public:
  /// `amplitude_nm` from the middle to the (unrounded) peak. The period is a whole number of ticks, a multiple of 4
  /// and at least 40.
  Triangle(double amplitude_nm, std::int64_t period_ticks) : amplitude_nm_(amplitude_nm), period_(period_ticks) {}

  SignalPoint next() {
    const SignalPoint point = at(tick_);
    tick_ = tick_ + 1 == period_ ? 0 : tick_ + 1;
    return point;
  }

 private:
  static constexpr std::int64_t kRoundingTicks = 5;

  [[nodiscard]] SignalPoint at(std::int64_t tick) const {
    const std::int64_t quarter = period_ / 4;
    const double slope = amplitude_nm_ / (static_cast<double>(quarter) * kTickS);
    // Fold the falling half onto the rising one, which runs from -quarter to +quarter.
    std::int64_t t = (tick + quarter) % period_;
    const bool falling = t >= 2 * quarter;
    if (falling) t -= 2 * quarter;
    t -= quarter;
    const SignalPoint rising = rising_at(t, quarter, slope);
    return falling ? -1.0 * rising : rising;
  }

  static SignalPoint rising_at(std::int64_t t, std::int64_t quarter, double slope) {
    const std::int64_t to_peak = quarter - t;
    const std::int64_t from_trough = quarter + t;
    if (to_peak < kRoundingTicks) return rounded(t, to_peak, slope);
    if (from_trough < kRoundingTicks) {
      const SignalPoint mirrored = rounded(-t, from_trough, slope);
      return {-mirrored.value, mirrored.slope};
    }
    return {slope * static_cast<double>(t) * kTickS, slope};
  }

  /// Between the start of the rounding and the peak, `to_peak` ticks before it: slope falls in a straight line to 0.
  static SignalPoint rounded(std::int64_t t, std::int64_t to_peak, double slope) {
    constexpr double kHalfS = static_cast<double>(kRoundingTicks) * kTickS;
    const double inside_s = kHalfS - static_cast<double>(to_peak) * kTickS;
    const double straight = slope * static_cast<double>(t) * kTickS;
    return {straight - slope * inside_s * inside_s / (2 * kHalfS), slope * (1.0 - inside_s / kHalfS)};
  }

  double amplitude_nm_;
  std::int64_t period_;
  std::int64_t tick_ = 0;
};

}  // namespace steerid
