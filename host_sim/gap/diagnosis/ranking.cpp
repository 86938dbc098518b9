// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gap/attribution/attribution_coefficients.hpp"
#include "gap/attribution/verdict_ids.hpp"

namespace steerid {

std::vector<RankedEffect> ranking_of(const AttributionInput& input, const std::vector<double>& probability,
                                     const std::vector<RecordDefect>& defects) {
  std::vector<RankedEffect> ranking;
  constexpr double kLeast = 1e-6;  // nothing is impossible
  for (const std::string& id : verdict_ids()) {
    double own = kLeast;
    for (std::size_t i = 0; i < input.all.size(); ++i) {
      if (input.all[i].id == id) own += probability[i];
    }
    if (id == "unknown") own += probability.back();
    ranking.push_back({id, own});
  }
  return with_defects(std::move(ranking), defects);
}

std::vector<RankedEffect> with_defects(std::vector<RankedEffect> ranking, const std::vector<RecordDefect>& defects) {
  for (const RecordDefect& defect : defects) {
    // A defect is read off, not inferred: what it leaves to the others is the chance of having read wrongly.
    const double certain = 1 - 0.35 * std::exp(-2.5 * std::max(0.0, defect.strength)) - 0.01;
    for (RankedEffect& one : ranking) one.probability *= 1 - certain;
    for (RankedEffect& one : ranking) {
      if (one.id == defect.effect.type->id) one.probability += certain;
    }
  }
  double sum = 0;
  for (const RankedEffect& one : ranking) sum += one.probability;
  for (RankedEffect& one : ranking) one.probability /= sum;
  std::ranges::stable_sort(ranking,
                           [](const RankedEffect& a, const RankedEffect& b) { return a.probability > b.probability; });
  return ranking;
}

std::vector<std::string> equivalent_to(const std::string& verdict, const std::vector<RankedEffect>& ranking,
                                       const AttributionInput& input) {
  constexpr double kProbability = 0.08;
  constexpr double kAsWell = 3;  // nats over the dispersion
  const auto named = std::ranges::find(input.all, verdict, &Evidence::id);
  const auto explains_as_well = [&](const std::string& id) {
    const auto other = std::ranges::find(input.all, id, &Evidence::id);
    if (!names_effect(verdict) || named == input.all.end()) return false;
    if (other == input.all.end() || !other->eligible) return false;
    const double behind = other->fit_nats + other->choose_nats - named->fit_nats - named->choose_nats;
    return kAttribution.fit * behind < kAsWell * std::max(1.0, named->excess);
  };
  std::vector<std::string> ids;
  for (const RankedEffect& one : ranking) {
    if (one.id != verdict && names_effect(one.id) && (one.probability > kProbability || explains_as_well(one.id))) {
      ids.push_back(one.id);
    }
  }
  return ids;
}

std::string best_effect(const std::vector<RankedEffect>& ranking, const Comparison& comparison) {
  for (const RankedEffect& one : ranking) {
    if (!names_effect(one.id)) continue;
    const bool fitted = std::ranges::any_of(comparison.candidates, [&](const Candidate& c) { return c.id == one.id; });
    if (fitted) return one.id;
  }
  return {};
}

}  // namespace steerid
