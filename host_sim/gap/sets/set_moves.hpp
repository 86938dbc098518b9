// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How a search over sets of changes goes on from one set: an effect of the simulation resized or removed, or as it is
// given again; a change taken back; an effect exchanged for another of its family. What is added is in
// gap/sets/additions.hpp.
#pragma once

#include <memory>
#include <vector>

#include "gap/sets/set_fit.hpp"
#include "gap/sets/spectral_search.hpp"

namespace steerid::gap {

/// A set to fit, and where from.
struct Move {
  EffectSet set;
  Point at;
  std::shared_ptr<const SlowCourse> course;
};

/// Without an effect that it has.
[[nodiscard]] Move without(Move from, const EffectType& type);

/// The simulation to begin from: with bristles, as friction that is given as ideal leads to none.
[[nodiscard]] Point given_to_begin(const SetSetting& setting);

/// The set with the effect behind the others.
[[nodiscard]] EffectSet with_added(EffectSet set, const Hypothesis& hypothesis);

/// The same set with the simulation's J, B and C.
[[nodiscard]] Move with_given_wheel(Move move, const SetSetting& setting);
/// The same, with the effects moved by what they have to make up for then, and the nats that this loses to second
/// order.
struct GivenWheelMove {
  Move move;
  double lost_nats = 0;
};
[[nodiscard]] GivenWheelMove with_given_wheel(const FittedSet& from, const SetSetting& setting);

/// Adds to `moves` those of `rest` with others of the family of `of`, at values that act like `added`.
void add_relatives(const Hypothesis& of, const Effect& added, const Move& rest, const SetSetting& setting,
                   std::vector<Move>& moves);

[[nodiscard]] std::vector<Move> revisions(const FittedSet& from, const SetSetting& setting);

/// Every effect that was added exchanged for the others of its family.
[[nodiscard]] std::vector<Move> exchanges(const FittedSet& from, const SetSetting& setting);

}  // namespace steerid::gap
