// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Springs in parallel, each with a slider of its own: a loop that knows where it turned round.
//
// Loaded for the first time the torque follows one curve f(s), z' = 1 - z^n, s being the angle gone over x. Turned
// round at (s_r, z_r) it goes along the same curve at twice the size, z = z_r -+ 2 f(|s - s_r|/2) (Masing's rule),
// until it is back where the loop inside which it moves was left; from there it goes on as if that detour had not been.
// So loops close, whichever way and however far the wheel moves in between, while one spring that bends, as Dahl's,
// creeps in them. Any f that bends one way only is a sum of springs with sliders: -f'' is the stiffness of those that
// slip at s.
//
// Source: G. Masing 1926; W. Iwan, J. Appl. Mech. 33 (1966); as hysteresis with nonlocal memory in F. Al-Bender et al.,
// IEEE TAC 50 (2005), the generalised Maxwell slip model.
// Cost: two looks at a table a call, and a place a turn that is not forgotten yet.
#pragma once

#include <cstddef>
#include <vector>

namespace steerid::effect {

class SlidingSprings {
 public:
  /// `sharpness`: n, from 0.5; below 1 the knee is rounder than an exponential's.
  explicit SlidingSprings(double sharpness);

  /// z where it is at `place`, the angle since the start over x, if it went there from where it is in one `way`, +1 or
  /// -1. It begins at 0.
  [[nodiscard]] double at(double place, int way) const;
  /// z where it is.
  [[nodiscard]] double here() const { return now_.z; }
  /// Goes there; returns z.
  double go(double place, int way);

 private:
  struct Knot {
    double z;
    double slope;  ///< over s
  };
  struct Turn {
    double place;
    double z;
  };
  [[nodiscard]] double first_loading(double gone) const;
  /// The number of the turn, from 1, whose curve is gone along at `place`; 0: as if it had never turned.
  [[nodiscard]] std::size_t curve_at(double place, int way) const;
  [[nodiscard]] const Turn& turn(std::size_t number) const;
  [[nodiscard]] double along(std::size_t number, double place, int way) const;

  std::vector<Knot> curve_;  ///< of the first loading, at equal distances
  std::vector<Turn> turns_;  ///< those that are not forgotten
  Turn now_{0, 0};           ///< the next turn, if the way changes here
  int way_ = 0;
};

}  // namespace steerid::effect
