// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_moves.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <utility>

#include "gap/sets/spectral_search.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// The numbers as a point.
Point point_of(const Eigen::VectorXd& x, const FittedSet& from) {
  Point point = Point::of(x, from.set.hypotheses());
  for (Effect& effect : point.effects) {  // of the other sign, where a size has none but a phase has half a turn
    const auto [scale, phase] = hypothesis_of(*effect.type)->linear();
    if (scale < 0 || phase < 0 || effect.values[static_cast<std::size_t>(scale)] >= 0) continue;
    effect.values[static_cast<std::size_t>(scale)] *= -1;
    effect.values[static_cast<std::size_t>(phase)] += std::numbers::pi;
  }
  return point;
}

Move without(const FittedSet& from, const EffectType& type) {
  return gap::without(Move{from.set, from.at(), from.course}, type);
}

/// The same, with what makes up for it: where the others stay as they are, the move looks worse than it is.
Move without_and_made_up(const FittedSet& from, const EffectType& type) {
  const Eigen::VectorXd x = conditioned(from, {{from.set.first_number_of(type), 0.0}});
  return gap::without(Move{from.set, point_of(x, from), from.course}, type);
}

/// With an effect of the simulation as it is given, and with the J, B and C that go with it there: those that were
/// found may make up for its size.
Move as_given_again(const FittedSet& from, const EffectType& type, const SetSetting& setting) {
  Move out = from.set.has(type) ? without(from, type) : Move{from.set, from.at(), from.course};
  std::erase(out.set.removed, &type);
  const Point given = given_to_begin(setting);
  out.set.parts.insert(out.set.parts.begin(), {hypothesis_of(type), Stands::kGiven});
  out.at.effects.insert(out.at.effects.begin(), *given.find(type));
  out.at.wheel = given.wheel;
  return out;
}

/// Other effects in the place of one that moves the wheel as they do. Torques add: of what the set has of them already
/// the size is the sum, and one of the simulation's may be gone by it.
void add_same_motion(const Effect& found, const Move& rest, const SetSetting& setting, std::vector<Move>& moves) {
  if (found.type->same_motion_as == nullptr) return;
  Move move = rest;
  for (const Effect& other : found.type->same_motion_as(found.values)) {
    const auto same = std::ranges::find(move.at.effects, other.type, &Effect::type);
    if (same != move.at.effects.end()) {
      same->values[0] += other.values[0];
      move.set = with_resized(move.set, *other.type);
    } else if (std::erase(move.set.removed, other.type) > 0) {
      move.set.parts.push_back({hypothesis_of(*other.type), Stands::kResized});
      move.at.effects.push_back(other);
    } else if (goes_with(*other.type, move.at.effects) && setting.allows(*other.type)) {
      move.set = with_added(move.set, *hypothesis_of(*other.type));
      move.at.effects.push_back(other);
    } else {
      return;
    }
  }
  const std::size_t first = moves.size();
  moves.push_back(move);
  for (const SetPart& part : move.set.parts) {
    if (part.as == Stands::kResized) moves.push_back(without(move, *part.type()));
  }
  for (std::size_t i = moves.size(); i-- > first;) moves.push_back(with_given_wheel(moves[i], setting));
}

/// One effect in the place of several that were added and move the wheel as it does.
void add_one_of_same_motion(const FittedSet& from, const SetSetting& setting, std::vector<Move>& moves) {
  for (const EffectType* type : effects()) {
    if (type->same_motion_as == nullptr || from.set.has(*type) || !setting.allows(*type)) continue;
    std::vector<Effect> others = type->same_motion_as(Effect(*type).values);
    const auto added = [&](const Effect& other) {
      const auto part = std::ranges::find(from.set.parts, other.type, &SetPart::type);
      return part != from.set.parts.end() && part->as == Stands::kAdded;
    };
    if (!std::ranges::all_of(others, added)) continue;
    Move rest{from.set, from.at(), from.course};
    for (Effect& other : others) {
      other = *rest.at.find(*other.type);
      rest = without(std::move(rest), *other.type);
    }
    if (!goes_with(*type, rest.at.effects)) continue;
    if (auto values = type->values_of_same_motion(others)) {
      const Hypothesis& hypothesis = *hypothesis_of(*type);
      moves.push_back(
          {with_added(rest.set, hypothesis), with_added(rest.at, hypothesis, std::move(*values)), rest.course});
    }
  }
}

/// A wheel that sticks too long, or not long enough, is elsewhere from then on, and a fit that begins with the given
/// friction ends near it. With the given J, B and C and no slow torque: those that were found make up for the size.
void add_other_sizes(const FittedSet& from, const Hypothesis& hypothesis, const SetSetting& setting,
                     std::vector<Move>& moves) {
  for (const double factor : {0.5, 2.0}) {
    Move move{with_resized(from.set, hypothesis.type()), from.at(), nullptr};
    move.at.wheel = setting.wheel;
    Effect& effect = *std::ranges::find(move.at.effects, &hypothesis.type(), &Effect::type);
    effect.values = scaled(hypothesis, 0, effect.values, {.nats = 0, .first = factor, .second = 0});
    moves.push_back(std::move(move));
  }
}

}  // namespace

Move without(Move from, const EffectType& type) {
  from.set = without(std::move(from.set), type);
  std::erase_if(from.at.effects, [&](const Effect& effect) { return effect.type == &type; });
  return from;
}

Point given_to_begin(const SetSetting& setting) { return to_run({setting.wheel, setting.given}); }

EffectSet with_added(EffectSet set, const Hypothesis& hypothesis) {
  set.parts.push_back({&hypothesis, Stands::kAdded});
  return set;
}

Move with_given_wheel(Move move, const SetSetting& setting) {
  move.set.wheel_given = true;
  move.at.wheel = setting.wheel;
  return move;
}

GivenWheelMove with_given_wheel(const FittedSet& from, const SetSetting& setting) {
  const Eigen::Vector3d given = Point{setting.wheel}.numbers();
  const Eigen::VectorXd x = conditioned(from, {{0, given[0]}, {1, given[1]}, {2, given[2]}});
  GivenWheelMove out{with_given_wheel({from.set, point_of(x, from), from.course}, setting)};
  const Eigen::VectorXd by = x - from.fit.x;
  if (from.fit.information.rows() == by.size()) out.lost_nats = by.dot(from.fit.information * by) / 2;
  return out;
}

void add_relatives(const Hypothesis& of, const Effect& added, const Move& rest, const SetSetting& setting,
                   std::vector<Move>& moves) {
  for (const auto& other : hypotheses()) {
    if (!other->of_family_of(of) || other.get() == &of || rest.set.has(other->type())) continue;
    if (!setting.allows(other->type())) continue;
    if (const auto alike = other->in_place_of(added)) {
      moves.push_back({with_added(rest.set, *other), with_added(rest.at, *other, *alike), rest.course});
    }
  }
}

std::vector<Move> revisions(const FittedSet& from, const SetSetting& setting) {
  std::vector<Move> moves;
  for (const SetPart& part : from.set.parts) {
    const EffectType& type = part.hypothesis->type();
    if (part.as == Stands::kGiven) {
      moves.push_back({with_resized(from.set, type), from.at(), from.course});
      moves.push_back(with_given_wheel(moves.back(), setting));
      if (part.hypothesis->sticks()) add_other_sizes(from, *part.hypothesis, setting, moves);
    }
    if (part.as != Stands::kGiven) {  // by what its torque does on the measured motion this may hardly be seen
      for (std::vector<double>& values : part.hypothesis->missed(from.at().find(type)->values)) {
        moves.push_back({from.set, from.at(), from.course});
        std::ranges::find(moves.back().at.effects, &type, &Effect::type)->values = std::move(values);
      }
    }
    moves.push_back(without(from, type));
    // Of a size that is held no information says what makes up for it: both would begin alike.
    const bool is_free = part.as != Stands::kGiven && !type.parameters[0].whole;
    if (is_free) moves.push_back(without_and_made_up(from, type));
    if (part.as != Stands::kAdded) moves.push_back(with_given_wheel(moves.back(), setting));
    if (part.as == Stands::kResized) moves.push_back(as_given_again(from, type, setting));
  }
  for (const EffectType* type : from.set.removed) moves.push_back(as_given_again(from, *type, setting));
  if (from.set.slow == SlowTorque::kCause) {
    moves.push_back({from.set, from.at(), from.course});
    moves.back().set.slow = SlowTorque::kFloor;
  }
  std::ranges::move(exchanges(from, setting), std::back_inserter(moves));
  return moves;
}

std::vector<Move> exchanges(const FittedSet& from, const SetSetting& setting) {
  std::vector<Move> moves;
  const Point at = from.at();
  for (const SetPart& part : from.set.parts) {
    if (part.as != Stands::kAdded) continue;
    const EffectType& type = part.hypothesis->type();
    add_relatives(*part.hypothesis, *at.find(type), without(from, type), setting, moves);
    add_same_motion(*at.find(type), without(from, type), setting, moves);
  }
  add_one_of_same_motion(from, setting, moves);
  return moves;
}

}  // namespace steerid::gap
