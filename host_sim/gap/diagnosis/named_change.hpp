// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A change of a simulation that is named: an effect that is added, of another size, or removed.
#pragma once

#include <optional>

#include "gap/diagnosis/diagnosis.hpp"

namespace steerid::gap {

struct NamedChange {
  ChangeKind kind = ChangeKind::kAdd;
  Effect effect;              ///< as the wheel has it; of one that is removed, as the simulation had it
  std::optional<Effect> was;  ///< as the simulation had it
  double probability = 0;
};

/// Makes it. An unmeasured torque is left out: it comes last, when all else is known.
void apply(const NamedChange& change, Simulation& simulation);

/// Undoes it.
void revert(const NamedChange& change, Simulation& simulation);

}  // namespace steerid::gap
