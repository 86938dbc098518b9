// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The linear wheel fitted to a record by free run: what is left of a gap once J, B, C are the best ones. Written apart
// from host_sim/fit; it serves to say how far a drawn effect stands above the noise.
//
// Gauss-Newton on J, B, C, the first angle and the first rate, with Levenberg's damping; four-stage Runge-Kutta at half
// the sampling interval, torque by quintics through six samples. About 0.1 s for 100 s.
#pragma once

#include "blind/simulation.hpp"
#include "log/record.hpp"

namespace steerid::blind {

struct LinearRefit {
  Arm arm;
  double residual_rms_rad = 0;
  double nrmse = 0;  ///< over the standard deviation of the angle
};

[[nodiscard]] LinearRefit refit(const Record& record, const Arm& start);

}  // namespace steerid::blind
