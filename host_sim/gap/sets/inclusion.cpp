// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/inclusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gap/sets/wheel_shift.hpp"
#include "gap/sets/inclusion_calibration.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

double logistic(double logit) { return 1 / (1 + std::exp(-logit)); }

/// A constant, then what the features are to the regression. A gap is explained where what is left is next to the
/// floor, or a small share of it: no simulation of a strong effect is exact.
std::array<double, 7> calibration_inputs(const ChangeFeatures& features) {
  constexpr double kLeast = 0.03;  // an excess that nothing needs to better
  constexpr double kLeastShare = 1e-4;
  constexpr double kAsExcess = 4;  // a quarter of the gap left is as bad as as much again as the floor
  const double left = std::min(features.excess - 1, kAsExcess * features.unexplained);
  return {1,
          std::copysign(std::log1p(std::abs(features.log_odds)), features.log_odds),
          std::log(std::max(left, kLeast)),
          std::log(std::clamp(features.share, kLeastShare, 1.0)),
          features.shift,
          features.revision ? 1.0 : 0.0,
          std::log1p(features.discrepancy)};
}

double calibrated(const ChangeFeatures& features) {
  const std::array<double, 7> inputs = calibration_inputs(features);
  double logit = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) logit += kInclusionCalibration[i] * inputs[i];
  // No calibration turns odds round: what the sets speak against is not likely.
  return std::min(logistic(logit), logistic(features.log_odds));
}

/// Log of the sum of the scores of sets that `is` is true of; minus infinity where there are none.
template <class Is>
double log_sum(const SearchedSets& sets, Is&& is) {
  double sum = 0;
  for (const FittedSet& one : sets.visited) {
    if (is(one)) sum += std::exp(sets.score(one) - sets.score(sets.answer()));
  }
  return std::log(sum);
}

/// The one with the highest score of those that `is` is true of.
template <class Is>
const FittedSet* best_of(const SearchedSets& sets, Is&& is) {
  const FittedSet* best = nullptr;
  for (const FittedSet& one : sets.visited) {
    if (is(one) && (best == nullptr || sets.score(one) > sets.score(*best))) best = &one;
  }
  return best;
}

}  // namespace

std::string_view name(ChangeKind kind) {
  constexpr std::array<std::string_view, 3> kNames = {"add", "resize", "remove"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool makes(const EffectSet& set, const EffectType& type, ChangeKind kind) {
  if (kind == ChangeKind::kRemove) return std::ranges::find(set.removed, &type) != set.removed.end();
  if (&type == &effect::unmeasured_torque) return kind == ChangeKind::kAdd && set.slow == SlowTorque::kCause;
  const Stands as = kind == ChangeKind::kAdd ? Stands::kAdded : Stands::kResized;
  return std::ranges::any_of(set.parts,
                             [&](const SetPart& part) { return part.as == as && &part.hypothesis->type() == &type; });
}

namespace {

/// Changes of which a set makes one at most: an effect of the simulation is resized or removed, and of a family one is
/// added. That any of them is made and which one are two questions.
struct Alternatives {
  std::vector<ChangeInclusion> changes;
  double probability = 0;  ///< that any of them is made
};

std::vector<Alternatives> alternatives_of(const SetSetting& setting) {
  std::vector<Alternatives> all;
  for (const Effect& given : setting.given) {
    all.push_back({{{given.type, ChangeKind::kResize}, {given.type, ChangeKind::kRemove}}});
  }
  std::vector<std::pair<Hypothesis::Family, std::size_t>> families;
  for (const EffectType* type : effects()) {
    const bool known = std::ranges::find(setting.given, type, &Effect::type) != setting.given.end();
    const Hypothesis* hypothesis = hypothesis_of(*type);
    if (known || (hypothesis == nullptr && type != &effect::unmeasured_torque)) continue;
    const auto family = hypothesis == nullptr ? Hypothesis::Family::kNone : hypothesis->family();
    const auto same = std::ranges::find(families, family, &std::pair<Hypothesis::Family, std::size_t>::first);
    if (family != Hypothesis::Family::kNone && same != families.end()) {
      all[same->second].changes.push_back({type, ChangeKind::kAdd});
      continue;
    }
    families.emplace_back(family, all.size());
    all.push_back({{{type, ChangeKind::kAdd}}});
  }
  return all;
}

/// What is common to all changes of one answer.
class Judge {
 public:
  Judge(const SearchedSets& sets, const SetSetting& setting, double discrepancy)
      : sets_(sets), setting_(setting), discrepancy_(discrepancy) {
    const FittedSet& given = sets.visited[0];
    const FittedSet& freed = sets.visited[1];
    const FittedSet& near = freed.nats() < given.nats() ? freed : given;
    constexpr double kNoGap = 0.05;  // of the floor
    excess_gap_ = std::max(near.excess() - 1, kNoGap);
    gap_nats_ =
        std::max(near.nats() - sets.answer().nats(), kNoGap * (given.fit.misfit[0].lines + given.fit.misfit[1].lines));
  }

  [[nodiscard]] ChangeFeatures of(const FittedSet& answer) const {
    ChangeFeatures out;
    out.excess = answer.excess();
    out.unexplained = std::clamp(std::max(answer.excess() - 1, 0.0) / excess_gap_, 0.0, 1.0);
    out.shift = shift_at_least(setting_.wheel, answer.fit);
    out.discrepancy = discrepancy_;
    return out;
  }

  /// The features of a question: do the sets that `any` is true of hold the answer, or the others?
  template <class Any>
  [[nodiscard]] ChangeFeatures asked(Any&& any) const {
    ChangeFeatures features = of(sets_.answer());
    const double with = log_sum(sets_, any);
    const double rest = log_sum(sets_, [&](const FittedSet& set) { return !any(set); });
    constexpr double kMost = ChangeFeatures::kMostOdds;
    features.log_odds = !std::isfinite(with)   ? -kMost
                        : !std::isfinite(rest) ? kMost
                                               : std::clamp(with - rest, -kMost, kMost);
    const FittedSet* rival = best_of(sets_, [&](const FittedSet& set) { return !any(set); });
    if (rival != nullptr && std::isfinite(with)) {
      features.share = std::clamp((rival->nats() - best_of(sets_, any)->nats()) / gap_nats_, 0.0, 1.0);
    }
    return features;
  }

  void settle(Alternatives& one) const {
    const auto any = [&](const FittedSet& set) {
      return std::ranges::any_of(one.changes,
                                 [&](const auto& change) { return makes(set.set, *change.type, change.kind); });
    };
    ChangeFeatures features = asked(any);
    features.revision = one.changes.front().kind != ChangeKind::kAdd;
    one.probability = calibrated(features);
    const double with = log_sum(sets_, any);
    for (ChangeInclusion& change : one.changes) {
      const double own =
          log_sum(sets_, [&](const FittedSet& set) { return makes(set.set, *change.type, change.kind); });
      change.features = features;
      change.probability = std::isfinite(own) ? std::exp(own - with) : 0;  // of those of the question
    }
  }

 private:
  const SearchedSets& sets_;
  const SetSetting& setting_;
  double discrepancy_;
  double excess_gap_ = 0;  // before any change but those of J, B and C
  double gap_nats_ = 0;
};

}  // namespace

std::vector<const ChangeInclusion*> in_place_of(const SearchedSets& sets, const FittedSet& one,
                                                const ChangeInclusion& change,
                                                const std::vector<ChangeInclusion>& changes) {
  constexpr double kAsWell = 3;  // nats: odds of 20 to 1
  std::vector<const ChangeInclusion*> all;
  const auto makes_it = [](const FittedSet& set, const ChangeInclusion& its) {
    return makes(set.set, *its.type, its.kind);
  };
  for (const FittedSet& other : sets.visited) {
    if (other.set.changes() != one.set.changes() || sets.score(other) < sets.score(one) - kAsWell) continue;
    if (makes_it(other, change)) continue;
    const ChangeInclusion* instead = nullptr;
    bool alone = true;
    for (const ChangeInclusion& its : changes) {
      if (!makes_it(other, its) || makes_it(one, its)) continue;
      alone = alone && instead == nullptr;
      instead = &its;
    }
    if (alone && instead != nullptr && std::ranges::find(all, instead) == all.end()) all.push_back(instead);
  }
  return all;
}

std::size_t likely_answer(const SearchedSets& sets, const std::vector<ChangeInclusion>& changes) {
  constexpr double kLikely = 0.6;  // a wrong name costs one and a half times what a missing one does
  double score = -std::numeric_limits<double>::infinity();
  std::size_t answer = 0;
  for (std::size_t i = 0; i < sets.visited.size(); ++i) {
    const FittedSet& one = sets.visited[i];
    const auto likely = [&](const ChangeInclusion& change) {
      double probability = change.probability;
      if (probability >= kLikely || !makes(one.set, *change.type, change.kind)) return true;
      for (const ChangeInclusion* other : in_place_of(sets, one, change, changes)) probability += other->probability;
      return probability >= kLikely;
    };
    if (sets.score(one) > score && std::ranges::all_of(changes, likely)) {
      score = sets.score(one);
      answer = i;
    }
  }
  return answer;
}

namespace {

/// What is sure as a whole may be shared by changes of which none is: an offset of the torque or another weight. That
/// anything is changed is therefore asked first; where the single questions together say less, their odds grow by one
/// factor until they say as much. None grows beyond its odds among the sets.
void agree(std::vector<Alternatives>& all, double any) {
  const auto grown = [](const Alternatives& one, double by) {
    const double p = std::clamp(one.probability, 1e-12, 1 - 1e-12);
    const double most = std::max(p, logistic(one.changes.front().features.log_odds));
    return std::min(logistic(std::log(p / (1 - p)) + by), most);
  };
  const auto nothing = [&](double by) {
    double product = 1;
    for (const Alternatives& one : all) product *= 1 - grown(one, by);
    return product;
  };
  double low = 0;
  double high = 30;  // log of the factor
  if (nothing(low) <= 1 - any) return;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = (low + high) / 2;
    (nothing(middle) > 1 - any ? low : high) = middle;
  }
  for (Alternatives& one : all) one.probability = grown(one, low);
}

}  // namespace

Inclusion inclusion_of(const SearchedSets& sets, const SetSetting& setting, double discrepancy) {
  Inclusion out;
  const Judge judge(sets, setting, discrepancy);
  std::vector<Alternatives> all = alternatives_of(setting);
  for (Alternatives& one : all) judge.settle(one);
  agree(all, calibrated(judge.asked([](const FittedSet& set) { return set.set.changes() > 0; })));
  double unchanged = 1;  // the probability that nothing that was tried is changed
  for (Alternatives& one : all) {
    unchanged *= 1 - one.probability;
    for (ChangeInclusion& change : one.changes) change.probability *= one.probability;
    out.changes.insert(out.changes.end(), one.changes.begin(), one.changes.end());
  }
  std::ranges::stable_sort(out.changes, [](const auto& a, const auto& b) { return a.probability > b.probability; });
  out.answer = likely_answer(sets, out.changes);
  // What is no change is nothing, J, B and C, or something that no set holds.
  ChangeFeatures reached = judge.of(sets.visited[out.answer]);
  reached.log_odds = ChangeFeatures::kMostOdds;
  reached.share = 1;
  const double explained = sets.visited[out.answer].set.changes() > 0 ? 0 : calibrated(reached);
  const auto plain = [&](bool given) {
    return log_sum(sets, [&](const FittedSet& one) { return one.set.changes() == 0 && one.set.wheel_given == given; });
  };
  const double ahead = plain(false) - plain(true);
  const double as_given = std::isnan(ahead) ? 0 : 1 / (1 + std::exp(ahead));
  out.none = unchanged * explained * as_given;
  out.parameters = unchanged * explained * (1 - as_given);
  out.unknown = unchanged * (1 - explained);
  return out;
}

}  // namespace steerid
