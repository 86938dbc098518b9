// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/next_experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

constexpr std::size_t kMostModels = 4;

/// What the set changes, in words.
std::vector<std::string> changes_of(const EffectSet& set) {
  std::vector<std::string> all;
  for (const SetPart& part : set.parts) {
    const std::string id(part.hypothesis->type().id);
    if (part.as == Stands::kAdded) all.push_back(id);
    if (part.as == Stands::kResized) all.push_back(id + " of another size");
  }
  for (const EffectType* type : set.removed) all.push_back(fmt::format("{} removed", type->id));
  if (set.slow == SlowTorque::kCause) all.emplace_back(effect::unmeasured_torque.id);
  return all;
}

/// `beside`: what it is told apart from.
std::string words(const EffectSet& set, const EffectSet& beside) {
  const std::vector<std::string> own = changes_of(set);
  const std::vector<std::string> others = changes_of(beside);
  if (own.empty()) return "no change";
  const bool part = own.size() < others.size() && std::ranges::all_of(own, [&](const std::string& one) {
                      return std::ranges::find(others, one) != others.end();
                    });
  return fmt::format("{}{}", fmt::join(own, " with "), part ? " alone" : "");
}

/// The set as another drive can show it: J, B and C free, nothing that has a course in time of its own.
FittedSet ahead(FittedSet one) {
  one.set.wheel_given = false;
  one.set.slow = SlowTorque::kFloor;
  Point at = one.at();
  std::erase_if(at.effects, [](const Effect& effect) { return hypothesis_of(*effect.type)->timed(); });
  std::erase_if(one.set.parts, [](const SetPart& part) { return part.hypothesis->timed(); });
  one.fit.x = at.numbers();
  return one;
}

/// A set that a probe has to tell from the answer, for the sake of a change that is unsettled.
struct Doubt {
  const FittedSet* set = nullptr;
  double weight = 0;  ///< the probability that the change is not as the answer has it
  const EffectType* about = nullptr;
};

/// The likeliest of the sets that are asked for; null where there is none.
template <typename Asked>
const FittedSet* likeliest(const SearchedSets& sets, Asked asked) {
  const FittedSet* found = nullptr;
  for (const FittedSet& one : sets.visited) {
    if (asked(one) && (found == nullptr || sets.score(one) > sets.score(*found))) found = &one;
  }
  return found;
}

/// One or two a change that is unsettled, the weightiest first.
std::vector<Doubt> doubts_of(const SetAnswer& found) {
  const SearchedSets& sets = found.judged();
  const FittedSet& answer = sets.visited[found.inclusion().answer];
  const std::vector<double> probability = sets.probabilities();
  std::vector<Doubt> all;
  for (const ChangeInclusion& change : found.inclusion().changes) {
    const auto made_by = [&](const EffectSet& set) { return makes(set, *change.type, change.kind); };
    const bool made = made_by(answer.set);
    const auto otherwise = [&](const FittedSet& one) { return one.eligible && made_by(one.set) != made; };
    const FittedSet* rival = likeliest(sets, otherwise);
    if (rival == nullptr) continue;
    double weight = made ? 1 - change.probability : change.probability;
    double of_sets = 0;
    for (std::size_t i = 0; i < sets.visited.size(); ++i) of_sets += otherwise(sets.visited[i]) ? probability[i] : 0;
    weight = std::max(weight, of_sets);
    if (weight <= kDoubt) continue;
    all.push_back({rival, weight, change.type});
    // The probe's record is diagnosed on its own. What this record shows of the change is not in it.
    const FittedSet* alone = likeliest(sets, [&](const FittedSet& one) {
      return made && !made_by(one.set) && one.set.changes() + 1 == answer.set.changes() &&
             one.set.changes_within(answer.set);
    });
    if (alone != nullptr && alone != rival) all.push_back({alone, weight, change.type});
  }
  std::ranges::stable_sort(all, std::ranges::greater(), &Doubt::weight);
  return all;
}

}  // namespace

NextExperiment next_experiment(const SetAnswer& found, const PreparedRecord& prepared) {
  const SearchedSets& sets = found.judged();
  const FittedSet& answer = sets.visited[found.inclusion().answer];
  const std::vector<Doubt> doubts = doubts_of(found);
  if (const double unknown = found.inclusion().unknown; doubts.empty() && unknown > kDoubt) {
    return {.why = fmt::format(
                "No change of the library is in doubt. Whether something else is missing is not settled (probability "
                "{:.2f}), and no probe tells what it would be.",
                unknown)};
  }
  if (doubts.empty()) {
    return {.why =
                "Nothing is left to settle: every change that was tried is made, or left out, with a probability of "
                "95 % or more."};
  }
  const SetFitter fitter(found.setting());
  const auto standing = [&](const FittedSet& one, std::string name, const Doubt& doubt) {
    return Standing{std::move(name), doubt.weight, one.at(), fitter.fitted(one.set), doubt.about};
  };
  std::vector<EffectSet> seen = {ahead(found.own(answer)).set};
  std::vector<Standing> models = {standing(ahead(found.own(answer)), words(answer.set, doubts.front().set->set), {})};
  for (const Doubt& doubt : doubts) {
    const FittedSet one = ahead(found.own(*doubt.set));
    const auto same = [&](const EffectSet& other) { return other.name() == one.set.name(); };
    if (models.size() == kMostModels || std::ranges::any_of(seen, same)) continue;
    seen.push_back(one.set);
    models.push_back(standing(one, words(doubt.set->set, answer.set), doubt));
  }
  if (models.size() == 1) {
    return {.why = fmt::format("Whether there is {} is not settled, and no probe settles it: its course in another "
                               "drive is not known beforehand.",
                               doubts.front().about->id)};
  }
  return best_probe(models, {.prepared = prepared,
                             .floor = found.own(answer).fit.floor,
                             .dispersion = sets.dispersion,
                             .threads = found.setting().threads});
}

}  // namespace steerid::gap
