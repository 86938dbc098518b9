// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether the angle was read by another clock than the torques, and by how much that drifts (ADR 31).
//
// The alternative of fit/model_check.hpp is taken for a drift where it is the likeliest and nothing else comes near:
// what any other alternative or an arm that changes explains as well, what explains next to nothing, and what no two
// crystals differ by is none.
#pragma once

#include "log/resample.hpp"

namespace steerid {

/// By how much later the angle comes every second; 0 where nothing says so, or the driver's own torque is not known.
[[nodiscard]] double clock_drift_per_s(const Resampled& resampled, bool torque_offset);

}  // namespace steerid
