// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether what no effect explains is a drift between the clocks of the angle and of the torques, as two loggers have it
// (20 to 200 ppm).
//
// Where the angle is recorded late by tau + d (t - tm), tm the middle of the record, it is off by
//
//   -(tau + d (t - tm)) dtheta/dt
//
// to first order, which misses 2 % of its power at 5 Hz and 10 ms. d is the regression of what a wheel with free J, B,
// C leaves on that, on whitened lines, beside J, B, C, tau, and a wheel whose J, B and C change as (t - tm), which is
// late by more and more where it is slow.
#pragma once

#include <optional>

#include "gap/sets/set_fit.hpp"

namespace steerid::gap {

struct ClockDrift {
  double per_s = 0;  ///< d: by how much later the angle comes, s in a second
  double nats = 0;   ///< of log likelihood that it gains, over what is left of a line
  double share = 0;  ///< of what is left above the noise beside a delay and a wheel that changes

  [[nodiscard]] bool is_plain() const;
  /// Plainly there, and a tenth of what is left.
  [[nodiscard]] bool matters() const;
};

/// Of a fit to the record of `fitter`; nothing where the wheel does not move or nothing is left.
[[nodiscard]] std::optional<ClockDrift> clock_drift_left(const FittedSet& one, const SetFitter& fitter);

}  // namespace steerid::gap
