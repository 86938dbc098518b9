// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A simulation with changes: what a diagnosis of a simulation as it is tries.
//
// Every effect of the simulation is kept as it is given, has another size, or is not there; effects are added; J, B and
// C are those given or others. A set is the answer to "what do I have to change?".
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/likelihood/whittle.hpp"
#include "gap/model/point.hpp"
#include "plant/effects/effect.hpp"

namespace steerid::gap {

/// How an effect stands in a set.
enum class Stands {
  kGiven,    ///< with the size that the simulation has; what is no size is free (Hypothesis::sizes())
  kResized,  ///< in the simulation, of another size
  kAdded,
};

struct SetPart {
  const Hypothesis* hypothesis = nullptr;
  Stands as = Stands::kAdded;
  [[nodiscard]] const EffectType* type() const { return &hypothesis->type(); }
};

struct EffectSet {
  std::vector<SetPart> parts;              ///< given and resized ones first, in the simulation's order
  std::vector<const EffectType*> removed;  ///< of the simulation
  bool wheel_given = true;                 ///< J, B and C are the simulation's
  SlowTorque slow = SlowTorque::kFloor;    ///< kCause: an unmeasured torque is added

  [[nodiscard]] Parts hypotheses() const;
  /// The same for the same set.
  [[nodiscard]] std::string name() const;
  [[nodiscard]] bool has(const EffectType& type) const;
  /// The place of an effect's first number among the set's, of which J, B and C are the first three.
  [[nodiscard]] Eigen::Index first_number_of(const EffectType& type) const;
  /// How many changes it makes, J, B and C aside.
  [[nodiscard]] std::size_t changes() const;
  /// Whether the other one makes every change that this one makes.
  [[nodiscard]] bool changes_within(const EffectSet& other) const;
};

/// Whether a simulation can hold the effect beside those that are there, and a record show both: of one family one
/// record shows one at most, as what the second adds is a bend of the first.
[[nodiscard]] bool goes_with(const EffectType& type, const std::vector<Effect>& present);

/// Whether two free effects of the set share a torque that only their sum tells: friction that differs between the ways
/// is Coulomb friction and a constant torque, so that a constant torque beside it is free to be any.
[[nodiscard]] bool has_one_torque_twice(const EffectSet& set);

/// An effect of the set that the simulation has, in another size.
[[nodiscard]] EffectSet with_resized(EffectSet set, const EffectType& type);

[[nodiscard]] EffectSet without(EffectSet set, const EffectType& type);

}  // namespace steerid::gap
