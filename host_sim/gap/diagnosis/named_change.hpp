// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A named change of a simulation, an effect that is added, of another size, or removed: made and undone.
#pragma once

#include "gap/diagnosis/diagnosis.hpp"

namespace steerid::gap {

/// Makes it. An unmeasured torque is left out: it comes last, when all else is known.
void apply(const Cause& change, Simulation& simulation);

/// Undoes it.
void revert(const Cause& change, Simulation& simulation);

}  // namespace steerid::gap
