// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/named_change.hpp"

#include <vector>

#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {

void apply(const Cause& change, Simulation& simulation) {
  const EffectType* type = change.effect.type;
  if (type == &effect::unmeasured_torque) return;
  if (change.change != ChangeKind::kAdd) {
    std::erase_if(simulation.effects, [&](const Effect& one) { return one.type == type; });
  }
  if (change.change != ChangeKind::kRemove) simulation.effects.push_back(change.effect);
}

void revert(const Cause& change, Simulation& simulation) {
  std::erase_if(simulation.effects, [&](const Effect& one) { return one.type == change.effect.type; });
  if (change.was) simulation.effects.push_back(*change.was);
}

}  // namespace steerid::gap
