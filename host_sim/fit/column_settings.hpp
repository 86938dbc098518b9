// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the task is told of a column, from a number of the host's.
#pragma once

#include <cmath>
#include <cstdint>

#include "identifier/closed_loop_identifier.hpp"

namespace steerid {

/// Those of every column, with this dry friction of the wheel above the bar, Nm, to a millionth: what fixed point
/// takes.
template <class Scalar>
[[nodiscard]] ClosedLoopSettings<Scalar> column_with_friction(double friction_nm) {
  ClosedLoopSettings<Scalar> column;
  column.wheel.friction_nm = Scalar(static_cast<std::int32_t>(std::lround(friction_nm * 1e6))) * Scalar(1e-6);
  return column;
}

}  // namespace steerid
