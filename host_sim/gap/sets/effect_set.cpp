// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/effect_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

bool of_one_family(const EffectType& a, const EffectType& b) {
  const Hypothesis* one = hypothesis_of(a);
  const Hypothesis* other = hypothesis_of(b);
  return one != nullptr && other != nullptr && one->of_family_of(*other);
}

}  // namespace

Parts EffectSet::hypotheses() const {
  Parts all;
  for (const SetPart& part : parts) all.push_back(part.hypothesis);
  return all;
}

std::string EffectSet::name() const {
  std::vector<std::string> words;
  for (const SetPart& part : parts) {
    words.push_back(fmt::format("{}{}", "=~+"[static_cast<std::size_t>(part.as)], part.type()->id));
  }
  for (const EffectType* type : removed) words.push_back(fmt::format("-{}", type->id));
  if (slow == SlowTorque::kCause) words.emplace_back("+unmeasured_torque");
  std::ranges::sort(words);
  return fmt::format("{} {}", wheel_given ? "given wheel" : "wheel", fmt::join(words, " "));
}

Eigen::Index EffectSet::first_number_of(const EffectType& type) const {
  Eigen::Index at = 3;
  for (auto part = parts.begin(); part->type() != &type; ++part) at += std::ssize(part->type()->parameters);
  return at;
}

bool EffectSet::has(const EffectType& type) const {
  return std::ranges::find(parts, &type, &SetPart::type) != parts.end();
}

std::size_t EffectSet::changes() const {
  const auto kept = static_cast<std::size_t>(std::ranges::count(parts, Stands::kGiven, &SetPart::as));
  return parts.size() - kept + removed.size() + (slow == SlowTorque::kCause ? 1 : 0);
}

bool EffectSet::changes_within(const EffectSet& other) const {
  if (slow == SlowTorque::kCause && other.slow != SlowTorque::kCause) return false;
  const auto removed_there = [&](const EffectType* type) {
    return std::ranges::find(other.removed, type) != other.removed.end();
  };
  const auto made_there = [&](const SetPart& part) {
    return part.as == Stands::kGiven || std::ranges::any_of(other.parts, [&](const SetPart& its) {
             return its.as == part.as && its.hypothesis == part.hypothesis;
           });
  };
  return std::ranges::all_of(removed, removed_there) && std::ranges::all_of(parts, made_there);
}

bool goes_with(const EffectType& type, const std::vector<Effect>& present) {
  if (std::ranges::any_of(present, [&](const Effect& one) { return of_one_family(*one.type, type); })) return false;
  try {
    std::vector<Effect> together = present;
    together.emplace_back(type);
    check_compatible(together);
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

bool has_one_torque_twice(const EffectSet& set) {
  const auto is_free = [&](const EffectType& type) {
    const auto part = std::ranges::find(set.parts, &type, &SetPart::type);
    return part != set.parts.end() && part->as != Stands::kGiven;
  };
  return std::ranges::any_of(set.parts, [&](const SetPart& part) {
    const EffectType& type = *part.type();
    if (type.same_motion_as == nullptr || !is_free(type)) return false;
    return std::ranges::any_of(type.same_motion_as(Effect(type).values),
                               [&](const Effect& other) { return is_free(*other.type); });
  });
}

EffectSet with_resized(EffectSet set, const EffectType& type) {
  const auto at = std::ranges::find(set.parts, &type, &SetPart::type);
  if (at->as == Stands::kGiven) at->as = Stands::kResized;
  return set;
}

EffectSet without(EffectSet set, const EffectType& type) {
  const auto at = std::ranges::find(set.parts, &type, &SetPart::type);
  if (at->as != Stands::kAdded) set.removed.push_back(&type);
  set.parts.erase(at);
  return set;
}

}  // namespace steerid::gap
