// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_moves.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "gap/model/compared_parts.hpp"

namespace steerid::gap {
namespace {

/// Without an effect that it has.
Move without(const FittedSet& from, const EffectType& type) {
  Move out{from.set, from.fit.x, from.course};
  out.set = without(std::move(out.set), type, out.x);
  return out;
}

/// With an effect of the simulation as it is given, and with the J, B and C that go with it there: those that were
/// found may make up for its size.
Move as_given_again(const FittedSet& from, const EffectType& type, const SetSetting& setting) {
  Move out{from.set, from.fit.x, from.course};
  if (out.set.has(type)) out.set = without(std::move(out.set), type, out.x);
  std::erase(out.set.removed, &type);
  const std::vector<Effect> given = given_to_begin(setting);
  std::vector<double> values = std::ranges::find(given, &type, &Effect::type)->values;
  out.set.parts.insert(out.set.parts.begin(), {hypothesis_of(type), Stands::kGiven});
  values.insert(values.begin(),
                {setting.wheel.inertia_kgm2, setting.wheel.damping_nms_per_rad, setting.wheel.stiffness_nm_per_rad});
  values.insert(values.end(), out.x.begin() + 3, out.x.end());
  out.x = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  return out;
}

}  // namespace

std::vector<Effect> given_to_begin(const SetSetting& setting) {
  std::vector<Effect> all = setting.given;
  for (Effect& effect : all) effect.values = hypothesis_of(*effect.type)->to_run(effect.values, setting.wheel);
  return all;
}

EffectSet with_added(EffectSet set, const Hypothesis& hypothesis) {
  set.parts.push_back({&hypothesis, Stands::kAdded});
  return set;
}

Move with_given_wheel(Move move, const SetSetting& setting) {
  move.set.wheel_given = true;
  move.x.head(3) = joined(setting.wheel, {});
  return move;
}

void add_relatives(const Hypothesis& of, const Effect& added, const Move& rest, const SetSetting& setting,
                   std::vector<Move>& moves) {
  if (of.family() == Hypothesis::Family::kNone) return;
  for (const auto& other : hypotheses()) {
    if (other->family() != of.family() || other.get() == &of || rest.set.has(other->type())) continue;
    if (std::ranges::find(setting.without, other->type().id) != setting.without.end()) continue;
    if (const auto alike = other->in_place_of(added)) {
      moves.push_back({with_added(rest.set, *other), point_at(rest.x, *alike), rest.course});
    }
  }
}

std::vector<Move> revisions(const FittedSet& from, const SetSetting& setting) {
  std::vector<Move> moves;
  for (const SetPart& part : from.set.parts) {
    const EffectType& type = part.hypothesis->type();
    if (part.as == Stands::kGiven) {
      moves.push_back({with_resized(from.set, type), from.fit.x, from.course});
      moves.push_back(with_given_wheel(moves.back(), setting));
    }
    moves.push_back(without(from, type));
    if (part.as == Stands::kResized) moves.push_back(as_given_again(from, type, setting));
  }
  for (const EffectType* type : from.set.removed) moves.push_back(as_given_again(from, *type, setting));
  if (from.set.slow == SlowTorque::kCause) {
    moves.push_back({from.set, from.fit.x, from.course});
    moves.back().set.slow = SlowTorque::kFloor;
  }
  std::ranges::move(exchanges(from, setting), std::back_inserter(moves));
  return moves;
}

std::vector<Move> exchanges(const FittedSet& from, const SetSetting& setting) {
  std::vector<Move> moves;
  for (const SetPart& part : from.set.parts) {
    if (part.as != Stands::kAdded) continue;
    const EffectType& type = part.hypothesis->type();
    Effect added(type);
    const double* values = from.fit.x.data() + from.set.place_of(type);
    added.values.assign(values, values + added.values.size());
    add_relatives(*part.hypothesis, added, without(from, type), setting, moves);
  }
  return moves;
}

}  // namespace steerid::gap
