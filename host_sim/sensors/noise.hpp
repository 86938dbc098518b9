// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// White Gaussian noise: y = x + n, n ~ N(0, sd^2), independent from sample to sample.
//
// It is the noise that is left in the samples, after whatever filter stands before them; nothing here shapes it.
#pragma once

#include <cstdint>

#include "sensors/during.hpp"
#include "sensors/random.hpp"

namespace steerid::sensor {

struct Noise {
  double sd = 0;  ///< standard deviation in the channel's unit (rad or Nm), >= 0; 0 is off
  During during;

  /// Draws one number whether the fault is on or not, so that the noise of a sample does not depend on `during`.
  [[nodiscard]] double apply(double x, std::int64_t instant_us, Random& random) const {
    if (sd == 0.0) return x;
    const double n = sd * random.normal();
    return during.covers(instant_us) ? x + n : x;
  }
};

}  // namespace steerid::sensor
