// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/inclusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "gap/sets/inclusion_calibration.hpp"
#include "gap/sets/line_nats.hpp"
#include "gap/sets/wheel_shift.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

double logistic(double logit) { return 1 / (1 + std::exp(-logit)); }

/// Nats that need no change of the library: of something else, and of what is not quite as simulated.
double other_nats(const ChangeFeatures& features) {
  const auto& w = kInclusionCalibration;
  return w.of_left * features.left_nats + features.discrepancy_nats + w.of_gap * features.gap_nats;
}

/// That what is seen of a change is the change.
double real(const ChangeFeatures& features) {
  const auto& w = kInclusionCalibration;
  const double ratio = std::log(features.gain_nats / other_nats(features));
  return logistic(w.changed + w.ratio * ratio + w.shift * features.shift);
}

/// That nothing is changed but J, B and C, by what these leave.
double nothing_else(const ChangeFeatures& features) {
  const auto& w = kInclusionCalibration;
  return logistic(w.unchanged + w.ratio * std::log(features.gain_nats / other_nats(features)));
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
using Alternatives = std::vector<ChangeInclusion>;

std::vector<Alternatives> alternatives_of(const SetSetting& setting) {
  std::vector<Alternatives> all;
  for (const Effect& given : setting.given) {
    all.push_back({{given.type, ChangeKind::kResize}, {given.type, ChangeKind::kRemove}});
  }
  std::vector<std::pair<Hypothesis::Family, std::size_t>> families;
  for (const EffectType* type : effects()) {
    const bool known = std::ranges::find(setting.given, type, &Effect::type) != setting.given.end();
    const Hypothesis* hypothesis = hypothesis_of(*type);
    if (known || (hypothesis == nullptr && type != &effect::unmeasured_torque)) continue;
    const auto family = hypothesis == nullptr ? Hypothesis::Family::kNone : hypothesis->family();
    const auto same = std::ranges::find(families, family, &std::pair<Hypothesis::Family, std::size_t>::first);
    if (family != Hypothesis::Family::kNone && same != families.end()) {
      all[same->second].push_back({type, ChangeKind::kAdd});
      continue;
    }
    families.emplace_back(family, all.size());
    all.push_back({{type, ChangeKind::kAdd}});
  }
  return all;
}

bool makes_any(const EffectSet& set, const Alternatives& changes) {
  return std::ranges::any_of(changes, [&](const auto& change) { return makes(set, *change.type, change.kind); });
}

/// What is common to all changes of one answer.
class Judge {
 public:
  Judge(const SearchedSets& sets, std::span<const RecordSets> records, double discrepancy_nats)
      : sets_(sets), records_(records), probability_(sets.probabilities()), lines_(sets.visited.size()) {
    // Where J, B or C has gone as far as it may, it makes up for what the set lacks, and what is best there is no
    // optimum: it speaks of something that no set holds. Not so where it goes there without any change, as the
    // simulation itself is off by more then.
    const bool tells = !sets.visited[1].wheel_at_limit;
    for (std::size_t i = 0; i < sets.visited.size(); ++i) {
      if (tells && sets.visited[i].wheel_at_limit) probability_[i] = 0;
    }
    const FittedSet& answer = sets.answer();
    answer_.gain_nats = static_cast<double>(records.size());  // what is not gained counts as one, of every record
    answer_.left_nats = answer.left_nats();
    answer_.gap_nats = std::max(sets.visited[1].nats() - answer.nats(), 0.0);
    answer_.discrepancy_nats = discrepancy_nats;
    for (const RecordSets& record : records) {
      const double shift = shift_at_least(record.setting.wheel, record.sets.find(answer.set)->fit);
      answer_.shift += shift / static_cast<double>(records.size());
    }
  }

  void settle(Alternatives& changes) {
    ChangeFeatures features = answer_;
    const auto made = [&](const FittedSet& one) { return makes_any(one.set, changes); };
    features.among_sets = share(made);
    if (const auto [with, without] = with_and_without(changes); without) {
      const double dispersion = std::max(1.0, sets_.nearest().excess());
      const auto score = [&](std::size_t i) { return SearchedSets::score(sets_.visited[i], dispersion); };
      features.gain_nats = std::max(score(with) - score(*without), features.gain_nats);
      const Eigen::ArrayXd nats = expected_nats(lines(with), lines(*without));
      features.left_nats = left_nats_on(acting_on(nats), lines(sets_.best));
      features.gap_nats = nats_beside(nats, expected_nats(lines(sets_.best), lines(1)));
    }
    for (ChangeInclusion& change : changes) {
      change.features = features;
      change.probability =
          real(features) * share([&](const FittedSet& one) { return makes(one.set, *change.type, change.kind); });
    }
  }

  /// That anything is changed: of every set the change that is shown best.
  [[nodiscard]] double anything(const std::vector<ChangeInclusion>& changes) const {
    double sum = 0;
    for (std::size_t i = 0; i < sets_.visited.size(); ++i) {
      double shown = 0;
      for (const ChangeInclusion& change : changes) {
        if (makes(sets_.visited[i].set, *change.type, change.kind)) shown = std::max(shown, real(change.features));
      }
      sum += probability_[i] * shown;
    }
    return sum;
  }

  /// That nothing is changed but J, B and C, if no change of the library is.
  [[nodiscard]] double only_wheel() const {
    ChangeFeatures features;
    features.gain_nats = answer_.gain_nats;
    features.left_nats = sets_.visited[sets_.answer().set.changes() == 0 ? sets_.best : 1].left_nats();
    features.discrepancy_nats = answer_.discrepancy_nats;
    return nothing_else(features);
  }

  /// That J, B and C are not either, if nothing else is.
  [[nodiscard]] double as_given() const {
    return logistic(sets_.score(sets_.visited[0]) - sets_.score(sets_.visited[1]));
  }

 private:
  /// In the probability of all sets.
  template <class Is>
  [[nodiscard]] double share(Is&& is) const {
    double sum = 0;
    for (std::size_t i = 0; i < sets_.visited.size(); ++i) sum += is(sets_.visited[i]) ? probability_[i] : 0;
    return sum;
  }

  /// The best set that makes one of the changes, and the best one that makes none and nothing else than that either;
  /// none where no set makes one, or no other.
  [[nodiscard]] std::pair<std::size_t, std::optional<std::size_t>> with_and_without(const Alternatives& changes) const {
    std::optional<std::size_t> with;
    std::optional<std::size_t> without;
    const auto better = [&](std::size_t i, const std::optional<std::size_t>& other) {
      return !other || sets_.score(sets_.visited[i]) > sets_.score(sets_.visited[*other]);
    };
    for (std::size_t i = 0; i < sets_.visited.size(); ++i) {
      if (makes_any(sets_.visited[i].set, changes) && better(i, with)) with = i;
    }
    if (!with) return {0, std::nullopt};
    for (std::size_t i = 0; i < sets_.visited.size(); ++i) {
      const EffectSet& set = sets_.visited[i].set;
      if (!makes_any(set, changes) && set.changes_within(sets_.visited[*with].set) && better(i, without)) without = i;
    }
    return {*with, without};
  }

  const SetLines& lines(std::size_t i) {
    if (!lines_[i]) {
      lines_[i].emplace();
      for (const RecordSets& record : records_) {
        lines_[i]->append(SetLines(*record.sets.find(sets_.visited[i].set), record.setting.whittle));
      }
    }
    return *lines_[i];
  }

  const SearchedSets& sets_;
  std::span<const RecordSets> records_;
  std::vector<double> probability_;             // of the sets, as far as they speak of changes
  std::vector<std::optional<SetLines>> lines_;  // of the visited sets, worked out where asked for
  ChangeFeatures answer_;
};

}  // namespace

std::vector<const ChangeInclusion*> in_place_of(const SearchedSets& sets, const FittedSet& one,
                                                const ChangeInclusion& change,
                                                const std::vector<ChangeInclusion>& changes) {
  std::vector<const ChangeInclusion*> all;
  const auto makes_it = [](const FittedSet& set, const ChangeInclusion& its) {
    return makes(set.set, *its.type, its.kind);
  };
  for (const FittedSet& other : sets.visited) {
    if (other.set.changes() != one.set.changes() || sets.score(other) < sets.score(one) - kStrong_nats) continue;
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
  double score = -std::numeric_limits<double>::infinity();
  std::size_t answer = 0;
  for (std::size_t i = 0; i < sets.visited.size(); ++i) {
    const FittedSet& one = sets.visited[i];
    const auto likely = [&](const ChangeInclusion& change) {
      if (!makes(one.set, *change.type, change.kind)) return true;
      if (change.refused) return false;
      double probability = change.probability;
      for (const ChangeInclusion* other : in_place_of(sets, one, change, changes)) {
        if (other->probability > change.probability) return false;
        probability += other->probability;
      }
      return probability >= kLikely;
    };
    if (sets.score(one) > score && std::ranges::all_of(changes, likely)) {
      score = sets.score(one);
      answer = i;
    }
  }
  return answer;
}

Inclusion inclusion_of(const SearchedSets& sets, std::span<const RecordSets> records, double discrepancy_nats) {
  Inclusion out;
  Judge judge(sets, records, discrepancy_nats);
  for (Alternatives& changes : alternatives_of(records.front().setting)) {
    judge.settle(changes);
    out.changes.insert(out.changes.end(), changes.begin(), changes.end());
  }
  std::ranges::stable_sort(out.changes, std::ranges::greater(), &ChangeInclusion::probability);
  out.answer = likely_answer(sets, out.changes);
  const double rest = 1 - judge.anything(out.changes);
  const double only_wheel = judge.only_wheel();
  const double as_given = judge.as_given();
  out.none = rest * only_wheel * as_given;
  out.parameters = rest * only_wheel * (1 - as_given);
  out.unknown = rest * (1 - only_wheel);
  return out;
}

}  // namespace steerid::gap
