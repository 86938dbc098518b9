// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether the angle was read by another clock than the torques (ADR 31).
//
// Drift. The alternative of fit/model_check.hpp is taken for one where it is the likeliest and nothing else comes near:
// what any other alternative or an arm that changes explains as well, what explains next to nothing, and what no two
// crystals differ by is none.
//
// Delay. Where rows hold channels, one that is no longer than a row is the log's own, if it is the likeliest
// alternative.
#pragma once

#include "log/angle_clock.hpp"
#include "log/resample.hpp"

namespace steerid {

/// The torques' own where nothing says otherwise, or the driver's own torque is not known.
[[nodiscard]] AngleClock check_clock(const Resampled& resampled, bool torque_offset);

}  // namespace steerid
