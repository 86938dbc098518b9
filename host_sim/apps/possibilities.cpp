// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/possibilities.hpp"

#include <algorithm>
#include <functional>

#include "apps/diagnosis_words.hpp"

namespace steerid {
namespace {

std::string in_words(const std::string& id, gap::ChangeKind change) {
  if (change == gap::ChangeKind::kRemove) return "no " + spoken(id);
  return change == gap::ChangeKind::kResize ? spoken(id) + " of another size" : spoken(id);
}

/// A change that was tried; the probability of one that is named stands with it.
void add_changes(const gap::Diagnosis& d, const std::string& id, std::vector<Possibility>& all) {
  const auto is_named = [&](gap::ChangeKind change) {
    return !d.surrogate && std::ranges::any_of(d.causes, [&](const gap::Cause& cause) {
      return cause.effect.type->id == id && cause.change == change;
    });
  };
  for (const gap::Cause& cause : d.causes) {
    if (cause.effect.type->id != id || d.surrogate) continue;
    all.push_back({id, in_words(id, cause.change), cause.probability, true});
  }
  for (const gap::ChangeInclusion& one : d.inclusion) {
    if (one.type->id != id || is_named(one.kind)) continue;
    all.push_back({id, in_words(id, one.kind), one.probability, false});
  }
}

}  // namespace

std::vector<Possibility> possibilities(const gap::Diagnosis& diagnosis) {
  std::vector<Possibility> all;
  for (const gap::RankedEffect& ranked : diagnosis.ranking) {
    const std::size_t before = all.size();
    add_changes(diagnosis, ranked.id, all);
    if (all.size() > before) continue;
    all.push_back({ranked.id, spoken(ranked.id), ranked.probability, ranked.id == diagnosis.verdict});
  }
  std::ranges::stable_sort(all, std::ranges::greater(), &Possibility::probability);
  return all;
}

}  // namespace steerid
