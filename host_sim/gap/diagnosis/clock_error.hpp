// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether what no effect explains is a drift between the clocks of the angle and of the torques, as two loggers have it
// (20 to 200 ppm), or a delay that is the log's own.
//
// Where the angle is recorded late by tau + d (t - tm), tm the middle of the record, it is off by
//
//   -(tau + d (t - tm)) dtheta/dt
//
// to first order, which misses 2 % of its power at 5 Hz and 10 ms. tau and d are the regression of what a wheel with
// free J, B, C leaves on that, on whitened lines, beside J, B, C, and a wheel whose J, B and C change as (t - tm),
// which is late by more and more where it is slow.
#pragma once

#include <optional>

#include "gap/sets/set_fit.hpp"

namespace steerid::gap {

struct ClockError {
  enum class Course { kConstant, kGrowing };
  double size = 0;   ///< by how much later the angle comes: tau, s, or d, s in a second
  double nats = 0;   ///< of log likelihood that it gains, over what is left of a line
  double share = 0;  ///< of what is left above the noise beside the other course and a wheel that changes

  [[nodiscard]] bool is_plain() const;
  /// Plainly there, and a tenth of what is left.
  [[nodiscard]] bool matters() const;
};

/// Of a fit to the record of `fitter`; nothing where the wheel does not move or nothing is left.
[[nodiscard]] std::optional<ClockError> clock_error_left(const FittedSet& one, const SetFitter& fitter,
                                                         ClockError::Course course);

}  // namespace steerid::gap
