// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// First-order lag: T y' + y = x, as of an RC filter or a slow transducer. At frequency f its gain is
// 1/sqrt(1 + (2 pi f T)^2), its phase -atan(2 pi f T); slow signals come T late.
//
// The answer to a cubic x is exact: y = p + (y0 - p(0)) exp(-tau/T) with p = x - T x' + T^2 x'' - T^3 x'''.
// The same lag on all three channels is a first-order anti-alias filter.
#pragma once

#include <cmath>

#include "plant/cubic.hpp"
#include "sensors/during.hpp"

namespace steerid::sensor {

struct Lag {
  static constexpr double kLongestS = 1.0;

  double time_constant_s = 0;  ///< T, 0 to kLongestS; 0 is off. 4.0e-3 is a corner of 40 Hz
  During during;               ///< outside, y = x; the lag itself goes on following x

  /// y after `tau_s` seconds of `x`, when it was `y0` at the start of `x`; `decay` is exp(-tau_s/T).
  [[nodiscard]] double respond(double y0, const Cubic& x, double tau_s, double decay) const {
    return settled(x, tau_s) + (y0 - settled(x, 0.0)) * decay;
  }
  [[nodiscard]] double decay(double tau_s) const { return std::exp(-tau_s / time_constant_s); }

 private:
  [[nodiscard]] double settled(const Cubic& x, double tau_s) const {
    const double t = time_constant_s;
    const double second = 2 * x.c2 + 6 * x.c3 * tau_s;
    return x.at(tau_s) - t * (x.slope(tau_s) - t * (second - t * 6 * x.c3));
  }
};

}  // namespace steerid::sensor
