// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a wheel was while its coarse angle stayed on a step.
//
// From a rounded angle the motion is known at the instants at which it passes from one value to the next: half-way
// between them. In between a run knows its shape, and what the run is off by changes no faster than from one such
// instant to the next. On the rounded values themselves, smoothed or not, the wheel would rest on every step and turn
// in between, and effects that depend on the motion would be worked out on stairs.
#pragma once

#include <span>
#include <vector>

#include "log/record.hpp"

namespace steerid::gap {

/// The motion of a record whose angle has steps of `step_rad`: `run_rad`, one angle a sample, moved by what it is off
/// by where the angle passes from step to step, in proportion to the time in between, and within the step that was
/// recorded. As recorded in a stretch in which nothing passes.
[[nodiscard]] std::vector<double> between_steps(const Record& record, std::span<const double> run_rad, double step_rad);

}  // namespace steerid::gap
