// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An elastic-plastic loop (plant/effects/presliding_hysteresis.cpp) over a motion that is known, without integrating
// it again: along one way dz/ds = 1 - z|z|^(n-1) depends on z alone, s being the angle gone over x. Whatever z a way
// begins at, the loop goes along one and the same curve from -1 to 1, from some place on it. That curve is worked out
// once for an n; a sample costs one look at it, a change of way one search.
#pragma once

#include <vector>

namespace steerid::gap {

class HysteresisLoop {
 public:
  /// `sharpness`: n, from 0.5.
  explicit HysteresisLoop(double sharpness);

  /// Goes on by `step`, the angle over x, with its sign; returns z. It begins at 0.
  double advance(double step);

 private:
  struct Point {
    double z;
    double slope;  ///< over s
  };
  [[nodiscard]] double z_at(double place) const;
  [[nodiscard]] double place_of(double z) const;

  std::vector<Point> curve_;  ///< from z = -1, equally spaced in s; flat beyond its end
  double place_ = 0;          ///< on the curve
  int way_ = 1;
};

}  // namespace steerid::gap
