// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The course in time of an unmeasured slow torque, from what a simulation leaves of the angle.
//
// The effect's spline (plant/effects/unmeasured_torque.cpp) is linear in its coefficients and most wheels are linear
// enough in so small a torque: ridge regression of the residual angle on the spline's responses, the prior being the
// slow torque's own size. Where another effect makes it another wheel, one that sticks or has compliance, runs of the
// simulation go on from there. A time course cannot be predicted from another part of a record. In the held-out part it
// is estimated from every second sample, so that the others still judge it.
#pragma once

#include <vector>

#include "gap/likelihood/noise_floor.hpp"
#include "gap/model/course_fit.hpp"
#include "log/record.hpp"
#include "plant/effects/effect.hpp"
#include "plant/simulation.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

/// `residual_rad` is measured minus simulated, NaN where unknown; `use` marks the samples to estimate from.
[[nodiscard]] Effect slow_torque(const Record& record, const WheelArm& wheel, const std::vector<double>& residual_rad,
                                 const std::vector<char>& use, const NoiseFloor& floor);

/// The same by runs of `simulation` with all else that acts, from `linear` on or from nothing, whichever is nearer.
/// Costs some hundred runs of the record.
[[nodiscard]] Effect slow_torque_by_runs(const Record& record, const std::vector<RunStretch>& stretches,
                                         const Simulation& simulation, const Effect& linear,
                                         const std::vector<char>& use, const NoiseFloor& floor);

/// Root mean square of an `unmeasured_torque` with a time course, at the knots of its cubic B-spline; 0 of no course.
[[nodiscard]] double course_rms_nm(const Effect& torque);

}  // namespace steerid::gap
