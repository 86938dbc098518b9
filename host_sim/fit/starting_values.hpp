// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where the Gauss-Newton iteration starts when nobody says: least squares on the differential equation itself, with
// angle and torque passed through the same state-variable filter 1/(s + lambda)^2, which supplies the derivatives
// without differentiating noise (Young 1964; Garnier and Wang 2008, chapter 1). Biased by noise, two to eighty times
// the Cramer-Rao bound, but near enough to converge from. The best filter corner is not known beforehand, so several
// answers are offered.
#pragma once

#include <span>
#include <vector>

#include "fit/segments.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

/// Candidates with J > 0, B >= 0, C >= 0, one a filter corner. `torque_offset`: allow for a constant torque.
std::vector<WheelArm> starting_values(std::span<const Segment> segments, bool torque_offset);

/// Light, average and braced arms of tables I and II of Lv et al. 2018, for records that lead least squares astray.
std::vector<WheelArm> typical_arms();

}  // namespace steerid
