// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Coloured chance with a slope: the answer of an oscillator to white noise, a second-order Gauss-Markov process.
//
//   x'' + 2 zeta w0 x' + w0^2 x = white noise,  rms(x) = rms,  rms(x') = w0 rms
//   power spectrum ~ 1 / ((w0^2 - w^2)^2 + (2 zeta w0 w)^2): flat (zeta = 1) or peaked (zeta << 1) at w0, then falling
//   with w^-4; autocorrelation for zeta = 1: (1 + w0 |tau|) exp(-w0 |tau|).
//
// A human being's torque is of this kind: slow corrections are well damped, tremor is a peak near 9 Hz. Knots are drawn
// from the exact transition, with w0 dt <= 0.2 but never closer than a tick, and joined by cubics; before the first
// knot the process has run for ever (it starts in its stationary distribution).
#pragma once

#include <cstdint>

#include "experiment/signal_point.hpp"
#include "sensors/random.hpp"

namespace steerid {

struct SmoothNoiseSettings {
  double rms = 0;              ///< >= 0, in the signal's unit; 0 is off
  double corner_hz = 0.3;      ///< w0 / 2 pi, > 0, up to 15
  double damping_ratio = 1.0;  ///< zeta, 0 < zeta <= 1
};

class SmoothNoise {
 public:
  SmoothNoise(const SmoothNoiseSettings& settings, std::uint64_t seed, std::uint64_t stream);

  SignalPoint next();

 private:
  void draw_knot();

  double rms_;
  Random random_;
  int ticks_between_knots_;
  int ticks_since_knot_ = 0;
  // x, x' at the newest knot, in units of rms and w0 rms.
  double x_ = 0;
  double v_ = 0;
  double rate_rad_s_;
  double transition_[2][2] = {};
  double innovation_[2][2] = {};  // lower triangle: Cholesky factor of the new knot's covariance
  Cubic piece_{};
};

}  // namespace steerid
