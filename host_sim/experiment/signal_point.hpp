// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A smooth signal at one tick, and how it runs to the next one.
#pragma once

#include "plant/cubic.hpp"
#include "port/sample.hpp"

namespace steerid {

inline constexpr double kTickS = static_cast<double>(kTickPeriodUs) * 1e-6;

struct SignalPoint {
  double value = 0;
  double slope = 0;  ///< per second

  constexpr SignalPoint& operator+=(const SignalPoint& other) {
    value += other.value;
    slope += other.slope;
    return *this;
  }
};

constexpr SignalPoint operator+(SignalPoint left, const SignalPoint& right) { return left += right; }
constexpr SignalPoint operator*(double factor, const SignalPoint& x) { return {factor * x.value, factor * x.slope}; }

/// The signal between two points `dt_s` apart.
constexpr Cubic between(const SignalPoint& from, const SignalPoint& to, double dt_s) {
  return Cubic::hermite(from.value, from.slope, to.value, to.slope, dt_s);
}

}  // namespace steerid
