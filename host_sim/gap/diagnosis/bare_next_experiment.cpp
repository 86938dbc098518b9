// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/bare_next_experiment.hpp"

#include <algorithm>

#include "gap/attribution/verdict_ids.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid {
namespace {

constexpr std::size_t kMostRivals = 3;
constexpr double kTold = 1e-3;  // smaller probabilities are not told apart

Standing standing(std::string name, double weight, const std::vector<Effect>& effects, const WheelArm& wheel,
                  const PreparedRecord& prepared, const Simulation& given) {
  const ComparedParts there = compared_parts(effects);
  return {std::move(name), weight, there.parts, joined(wheel, there.present),
          fitted_parameters(given.wheel, prepared.refit, there.parts)};
}

Standing standing(const Candidate& candidate, std::string name, double weight, const PreparedRecord& prepared,
                  const Simulation& given) {
  std::vector<Effect> effects;
  if (const auto effect = fitted_effect(candidate)) effects.push_back(*effect);
  return standing(std::move(name), weight, effects, wheel_of(candidate.fit.x), prepared, given);
}

/// The verdict (or what stands in for it) first, then the effects that come closest to it: by probability, and where
/// that says nothing by how well they fit. A slow torque of no known course cannot be simulated ahead.
std::vector<Standing> standing_models(const Diagnosis& diagnosis, const Comparison& comparison,
                                      const PreparedRecord& prepared, const Simulation& given) {
  struct Ranked {
    const Candidate* candidate;
    double probability;
  };
  std::vector<Ranked> ranked;
  for (const Candidate& one : comparison.candidates) {
    const auto found = std::ranges::find(diagnosis.ranking, one.id, &RankedEffect::id);
    const bool rival = names_effect(one.id) || one.id == diagnosis.verdict;
    if (rival && one.id != "unmeasured_torque") ranked.push_back({&one, found->probability});
  }
  std::ranges::sort(ranked, [](const Ranked& a, const Ranked& b) {
    const double pa = std::max(a.probability, kTold);
    const double pb = std::max(b.probability, kTold);
    return pa != pb ? pa > pb : a.candidate->fit.cost(kSeen) < b.candidate->fit.cost(kSeen);
  });
  std::vector<Standing> models;
  for (const Ranked& one : ranked) {
    if (models.size() > kMostRivals) break;
    models.push_back(standing(*one.candidate, one.candidate->id, std::max(one.probability, kTold), prepared, given));
  }
  return models;
}

/// Two effects at once against each of them alone; none where there is one, or one that cannot be simulated ahead.
std::vector<Standing> both_or_one(const Diagnosis& diagnosis, const Comparison& comparison,
                                  const PreparedRecord& prepared, const Simulation& given) {
  if (diagnosis.causes.size() < 2) return {};
  std::vector<Effect> both;
  std::string together;
  std::vector<Standing> models = {{}};
  for (const Cause& cause : diagnosis.causes) {
    const auto alone = std::ranges::find(comparison.candidates, cause.effect.type->id, &Candidate::id);
    if (alone == comparison.candidates.end() || alone->id == "unmeasured_torque") return {};
    both.push_back(cause.effect);
    together += (together.empty() ? "" : " with ") + alone->id;
    models.push_back(standing(*alone, alone->id + " alone", 1, prepared, given));
  }
  models.front() = standing(together, 1, both, diagnosis.with_effect.wheel, prepared, given);
  return models;
}

}  // namespace

NextExperiment next_experiment(const Diagnosis& diagnosis, const Comparison& comparison, const PreparedRecord& prepared,
                               const Simulation& given) {
  if (diagnosis.verdict == "unknown" && diagnosis.causes.empty()) {
    return {.why = "Nothing explains this record, so that there are no rivals for a probe to tell apart."};
  }
  std::vector<Standing> models = both_or_one(diagnosis, comparison, prepared, given);
  if (models.empty()) models = standing_models(diagnosis, comparison, prepared, given);
  if (models.size() < 2) return {.why = "No other effect of the library is left that a probe could tell apart."};
  const auto cost = [](const Candidate& one) { return one.fit.cost(kSeen); };
  const Candidate& best = *std::ranges::min_element(comparison.candidates, {}, cost);
  return best_probe(models, {.prepared = prepared,
                             .floor = best.fit.floor,
                             .dispersion = std::max(1.0, best.fit.excess(kSeen)),
                             .threads = 1});
}

}  // namespace steerid
