// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/pairs/pair_search.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <utility>

#include "gap/attribution/attribution_coefficients.hpp"
#include "gap/attribution/verdict_ids.hpp"
#include "gap/attribution/what_is_left.hpp"
#include "gap/comparison/dry_friction_forms.hpp"
#include "gap/comparison/free_run_stage.hpp"
#include "gap/comparison/preferred_fit.hpp"
#include "gap/comparison/wheel_shift.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/pairs/pair_meaning.hpp"
#include "gap/pairs/pair_starts.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

/// Two effects that undo each other fit nearly anything, with J, B and C beyond kFarthestShift.
class PairSearch {
 public:
  PairSearch(const ComparisonSetting& alone, const Comparison& singles, const AttributionInput& input)
      : alone_(alone), singles_(singles), input_(input) {}

  std::optional<CausePair> best() {
    constexpr double kBothStrong = 1.5;  // an excess of the best one alone
    const std::vector<std::size_t> order = most_likely_first();
    if (order.empty()) return std::nullopt;
    constexpr std::size_t kFirsts = 2;
    for (std::size_t i = 0; i < std::min(kFirsts, order.size()) && !reaches_floor(); ++i) {
      const Candidate& first = singles_.candidates[order[i]];
      if (best_ && (first.id == best_->first || first.id == best_->second.id)) continue;
      const Candidate held = with_slow_course(first);
      offer(beside(first.id, fitted_effect(held), held));
      if (gains_much_over(held)) take_turns();
      if (best_ && best_->unknown < 0.5) break;
    }
    const Candidate& likeliest = singles_.candidates[order.front()];
    if (!reaches_floor() && likeliest.fit.excess(kSeen) > kBothStrong) offer_from_balance(likeliest);
    settle_friction();
    put_in_place(likeliest);
    return best_;
  }

 private:
  enum class Kinds { kFromOther, kAnew };

  [[nodiscard]] std::vector<std::size_t> most_likely_first() const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < input_.all.size(); ++i) {
      const Evidence& one = input_.all[i];
      if (names_effect(one.id) && one.eligible && !coulomb_by_another_name(one)) order.push_back(i);
    }
    std::ranges::sort(order, {}, [&](std::size_t i) { return priced_nats(input_.all[i]); });
    return order;
  }

  /// A kind of dry friction that Coulomb's explains as well: beside a second effect it would soon show a difference
  /// that is not there.
  [[nodiscard]] bool coulomb_by_another_name(const Evidence& one) const {
    constexpr double kPlain = 12;  // nats
    return one.id != "coulomb_friction" && dry_friction(one.id) &&
           priced_nats(one) > nats_alone("coulomb_friction") - kPlain;
  }

  [[nodiscard]] double nats_alone(const std::string& id) const {
    const auto found = std::ranges::find(input_.all, id, &Evidence::id);
    return found == input_.all.end() ? std::numeric_limits<double>::infinity() : priced_nats(*found);
  }

  /// Whether the library has it.
  [[nodiscard]] bool has(const EffectType& type) const {
    return std::ranges::find(alone_.without, type.id) == alone_.without.end();
  }

  [[nodiscard]] bool reaches_floor() const {
    constexpr double kFloor = 1.2;
    return best_ && best_->unknown < 0.5 && best_->evidence.excess < kFloor;
  }

  bool offer(std::optional<CausePair> pair) {
    const bool better = pair && (!best_ || priced_nats(pair->evidence) < priced_nats(best_->evidence));
    if (better) best_ = std::move(pair);
    return better;
  }

  /// Of what one effect leaves.
  static constexpr double kMuch = 0.7;

  [[nodiscard]] bool gains_much_over(const Candidate& one) const {
    return best_ && best_->evidence.excess < kMuch * one.fit.excess(kSeen);
  }

  /// The second one found is held and the first looked for anew, and so on as long as much is gained.
  void take_turns() {
    constexpr int kTurns = 4;
    for (int turn = 0; turn < kTurns && best_ && !reaches_floor(); ++turn) {
      const double before = best_->evidence.excess;
      const std::optional<Effect> other = fitted_effect(best_->second);
      if (!offer(beside(best_->second.id, other, without_first(*best_, other)))) return;
      if (best_->evidence.excess > kMuch * before) return;
    }
  }

  /// The second effect of a pair where it is, alone.
  [[nodiscard]] Candidate without_first(const CausePair& pair, const std::optional<Effect>& effect) const {
    std::vector<Effect> present = alone_.present;
    if (effect) present.push_back(*effect);
    Candidate alone = pair.second;
    alone.fit.x = point_of(wheel_of(pair.second.fit.x), present);
    alone.motion = Motion::kMeasured;
    return alone;
  }

  /// A single effect with the slow torque in its runs, where it needs that.
  [[nodiscard]] Candidate with_slow_course(Candidate one) const {
    prefer_slow_course(alone_, compared_parts(alone_.present), one);
    return one;
  }

  /// The best effect beside `first`, which is fitted as `held`.
  [[nodiscard]] std::optional<CausePair> beside(const std::string& first, const std::optional<Effect>& effect,
                                                const Candidate& held) const {
    std::vector<Effect> present = alone_.present;
    if (effect) present.push_back(*effect);
    // The second one is looked for on the motion that the first one's run carries.
    const ComparedParts there = compared_parts(present);
    SimulatedModel run(alone_.record, there.parts, there.fixed, held.course);
    const SpectralRecord carried = carried_record(alone_.record, run, held.fit.x);
    ComparisonSetting setting = alone_.on(carried);
    setting.present = std::move(present);
    setting.slow = effect ? SlowTorque::kFloor : SlowTorque::kCause;
    setting.base_by_runs = held.motion == Motion::kFreeRuns;
    setting.base = setting.base_by_runs ? held.fit : on_motion(setting, there, held.fit);
    setting.course = held.course;
    return best_of(first, effect, setting, compare(setting));
  }

  /// A fit again on the motion that its own run carries, where the last one's carried it.
  [[nodiscard]] static Whittle::Fit on_motion(const ComparisonSetting& setting, const ComparedParts& there,
                                              const Whittle::Fit& fit) {
    constexpr int kSteps = 60;
    SpectralModel model(setting.record, there.parts);
    const auto fitted = fitted_parameters(setting.sim, setting.refit, there.parts);
    return setting.whittle.fit(model, fit.x, fitted, roles_of("", there), setting.slow, kSteps);
  }

  /// The best of what stands beside `first`.
  [[nodiscard]] std::optional<CausePair> best_of(const std::string& first, const std::optional<Effect>& effect,
                                                 const ComparisonSetting& setting, Comparison comparison) const {
    AttributionInput input = what_stands(effect, setting, comparison);
    note_out_of_place(first, effect, setting, comparison, input);
    if (!any_in_place(input)) return std::nullopt;
    for (Evidence& one : input.all) one.eligible = in_place(one);
    std::vector<double> probability = attribute(input, kPairAttribution);
    const std::size_t best = likeliest_of(probability);
    const std::size_t second = simplest_of_best(comparison, probability);
    const ComparedParts there = compared_parts(setting.present);
    const auto ask = [&](auto note, std::size_t of) {
      note(setting, there, comparison.candidates[of]);
      take_what_is_left(input.all[of], comparison.candidates[of]);
      probability = attribute(input, kPairAttribution);
    };
    ask(note_run, best);
    if (second != best) ask(note_run, second);
    // Shapes without a name speak for unknown alone: where that is likely they are not asked.
    if (probability.back() < 0.5) ask(note_shapes, best);
    const std::string& other = comparison.candidates[second].id;
    return CausePair{.first = first,
                     .leading = nats_alone(first) <= nats_alone(other) ? first : other,
                     .first_effect = effect,
                     .slow = setting.slow,
                     .second = comparison.candidates[second],
                     .evidence = input.all[second],
                     .unknown = probability.back()};
  }

  /// Keeps the pair that explains most with J, B and C where no simulation has them.
  void note_out_of_place(const std::string& first, const std::optional<Effect>& effect,
                         const ComparisonSetting& setting, const Comparison& comparison,
                         const AttributionInput& input) const {
    for (std::size_t i = 0; i < input.all.size(); ++i) {
      const Evidence& one = input.all[i];
      if (!one.eligible || in_place(one)) continue;
      const std::scoped_lock lock(out_of_place_mutex_);
      if (out_of_place_ && priced_nats(one) > priced_nats(out_of_place_->evidence)) continue;
      out_of_place_ = CausePair{.first = first,
                                .leading = first,
                                .first_effect = effect,
                                .slow = setting.slow,
                                .second = comparison.candidates[i],
                                .evidence = one,
                                .unknown = 1};
    }
  }

  /// Whether it may be named with the J, B and C that it needs.
  [[nodiscard]] static bool in_place(const Evidence& one) { return one.eligible && one.shift < kFarthestShift; }
  [[nodiscard]] static bool any_in_place(const AttributionInput& input) {
    return std::ranges::any_of(input.all, in_place);
  }

  /// What means something beside an effect, wherever J, B and C are.
  [[nodiscard]] AttributionInput what_stands(const std::optional<Effect>& effect, const ComparisonSetting& setting,
                                             const Comparison& comparison) const {
    AttributionInput input = attribution_input(comparison, setting.whittle, setting.sim);
    input.refit_excess = input_.refit_excess;
    for (std::size_t i = 0; i < input.all.size(); ++i) {
      Evidence& one = input.all[i];
      one.eligible = one.eligible && names_effect(one.id) && (one.simulated || !comparison.by_runs) &&
                     stand_together(effect, comparison.candidates[i]);
    }
    return input;
  }

  /// Whether both mean what their names say beside each other.
  [[nodiscard]] bool stand_together(const std::optional<Effect>& effect, const Candidate& second) const {
    const std::optional<Effect> one = fitted_beside(effect, second);
    const std::optional<Effect> other = fitted_effect(second);
    if (one && one->type == &effect::compliance && !leaves_wheel_inertia(*one)) return false;
    return !one || !other || steerid::stand_together(alone_.record, alone_.sim, wheel_of(second.fit.x), *one, *other);
  }

  /// Of those nearly as probable as the best the one with the fewest numbers: a drift that is over at once is an
  /// offset.
  [[nodiscard]] static std::size_t simplest_of_best(const Comparison& comparison,
                                                    const std::vector<double>& probability) {
    constexpr double kNearly = 0.5;
    const std::size_t best = likeliest_of(probability);
    std::size_t simplest = best;
    for (std::size_t i = 0; i < comparison.candidates.size(); ++i) {
      const auto numbers = [&](std::size_t k) { return comparison.candidates[k].fit.x.size(); };
      if (probability[i] > kNearly * probability[best] && numbers(i) < numbers(simplest)) simplest = i;
    }
    return simplest;
  }

  /// Where both effects are strong none is found alone, nor the other beside it: both at once from the balance of
  /// torques on the motion that the best single one carries.
  void offer_from_balance(const Candidate& single) {
    constexpr std::size_t kMost = 4;
    const ComparedParts before = compared_parts(alone_.present);
    SimulatedModel run(alone_.record, before.with(single.type), before.fixed);
    const SpectralRecord carried = carried_record(alone_.record, run, single.fit.x);
    const auto may_stand = [&](const EffectType& type) {
      // Its kind is settled afterwards.
      const bool richer = dry_friction(type.id) && &type != &effect::coulomb_friction && has(effect::coulomb_friction);
      return !richer && has(type) && goes_with(type, alone_.present);
    };
    const auto together = [](const EffectType& one, const EffectType& other) {
      return goes_with(other, {Effect(one)});
    };
    const bool plain = dry_friction(single.id) && has(effect::coulomb_friction);
    const EffectType& leading = plain ? effect::coulomb_friction : *single.type;
    const std::vector<PairStart> starts = pair_starts(carried, alone_.sim, kMost, leading, may_stand, together);
    std::vector<std::optional<CausePair>> pairs(starts.size());
    work_in_parallel(starts.size(), alone_.threads, [&](std::size_t i) { pairs[i] = from_start(starts[i]); });
    bool better = false;
    for (std::optional<CausePair>& pair : pairs) better = offer(std::move(pair)) || better;
    if (!better || reaches_floor()) return;
    Candidate second = best_->second;
    offer(fitted_pair(fitted_beside(best_->first_effect, second), {second}, best_->slow, prefer_slow_course));
  }

  [[nodiscard]] std::optional<CausePair> from_start(const PairStart& start) const {
    const Hypothesis* held = start.first;
    const Hypothesis* fitted = start.second;
    if (dry_friction(held->type().id)) std::swap(held, fitted);  // friction last, as where its kind is settled
    Effect effect(held->type());
    Effect second(fitted->type());
    const auto first_size = std::ssize(start.first->type().parameters);
    const double* values = start.x.data() + 3;
    std::copy_n(values + (held == start.first ? 0 : first_size), effect.values.size(), effect.values.begin());
    std::copy_n(values + (held == start.first ? first_size : 0), second.values.size(), second.values.begin());
    Candidate one{.id = std::string(second.type->id), .type = second.type, .fit = {}};
    std::vector<Effect> both = alone_.present;
    both.push_back(effect);
    both.push_back(second);
    one.fit.x = point_of(wheel_of(start.x), both);
    if (dry_friction(one.id)) one.fit.x = with_bristles(one);
    return fitted_pair(effect, {std::move(one)}, SlowTorque::kFloor, fit_from_here);
  }

  /// The best of candidates beside an effect, each fitted `by` something from where it is; `effect` has the first one's
  /// values then.
  [[nodiscard]] std::optional<CausePair> fitted_pair(const std::optional<Effect>& effect,
                                                     std::vector<Candidate> candidates, SlowTorque slow,
                                                     void (*by)(const ComparisonSetting&, const ComparedParts&,
                                                                Candidate&)) const {
    ComparisonSetting setting = alone_;
    if (effect) setting.present.push_back(*effect);
    setting.slow = slow;
    const ComparedParts there = compared_parts(setting.present);
    work_in_parallel(candidates.size(), setting.threads, [&](std::size_t i) { by(setting, there, candidates[i]); });
    Comparison comparison{.candidates = std::move(candidates),
                          .fixed = there.fixed,
                          .by_runs = !there.all_exact(),
                          .switches = singles_.switches || (effect && switches(effect->type->id)),
                          .slow = slow,
                          .swing_rad = singles_.swing_rad};
    return best_of(effect ? std::string(effect->type->id) : "unmeasured_torque", effect, setting,
                   std::move(comparison));
  }

  /// Two strong effects may have been found with J, B and C that make up for what neither was yet: where nothing else
  /// explains the record, fits begin anew from there with the simulation's J, B and C.
  void put_in_place(const Candidate& likeliest) {
    if (!out_of_place_ || (best_ && best_->unknown < 0.5)) return;
    if (out_of_place_->evidence.excess > kMuch * likeliest.fit.excess(kSeen)) return;
    const std::optional<CausePair> before = std::exchange(best_, out_of_place_);
    best_->second.fit.x.head<3>() = joined(alone_.sim, {});
    const CausePair placed = *best_;
    if (auto fitted = fitted_pair(fitted_beside(placed.first_effect, placed.second), {placed.second}, placed.slow,
                                  fit_from_here)) {
      best_ = std::move(fitted);
    }
    settle_friction();
    if (best_->unknown < 0.5) return;
    best_ = placed;
    settle_friction(Kinds::kAnew);
    if (best_->unknown > 0.5) best_ = before;
  }

  /// Kinds of one friction: what one is given is given to all.
  static void fit_as_the_others(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one) {
    const bool moved = one.course != nullptr;
    fit_from_here(setting, there, one);
    if (moved) prefer_slow_course(setting, there, one);
  }

  /// Dry friction took what was left of the other effect before that was found, and its kind may have been the one that
  /// takes most: with the other one beside it every kind is tried from the same place.
  void settle_friction(Kinds begin = Kinds::kFromOther) {
    constexpr double kFarOff = 10;  // an excess that no kind makes up for
    if (!best_ || best_->evidence.excess > kFarOff) return;
    const bool first = dry_friction(best_->first);
    if (first == dry_friction(best_->second.id)) return;
    const std::optional<Effect> held =
        first ? fitted_effect(best_->second) : fitted_beside(best_->first_effect, best_->second);
    const SlowTorque slow = best_->has_slow_torque() ? SlowTorque::kCause : SlowTorque::kFloor;
    const Effect friction = first ? *fitted_beside(best_->first_effect, best_->second) : *fitted_effect(best_->second);
    std::vector<Effect> both = alone_.present;
    if (held) both.push_back(*held);
    both.push_back(friction);
    Candidate given{.id = std::string(friction.type->id), .type = friction.type, .fit = {}};
    given.course = best_->second.course;
    given.fit.x = point_of(wheel_of(best_->second.fit.x), both);
    std::optional<CausePair> settled = fitted_pair(held, kinds_of_friction(given, begin), slow, fit_as_the_others);
    if (settled && settled->unknown < std::max(0.5, best_->unknown)) best_ = std::move(settled);
  }

  /// Every kind in place of a given one.
  [[nodiscard]] std::vector<Candidate> kinds_of_friction(const Candidate& given, Kinds begin) const {
    std::vector<Candidate> kinds;
    for (const auto& hypothesis : hypotheses()) {
      const EffectType& type = hypothesis->type();
      if (!dry_friction(type.id) || !has(type)) continue;
      kinds.push_back(given);
      kinds.back().id = type.id;
      kinds.back().type = &type;
      if (&type != given.type) kinds.back().fit.x = as_kind(type, given);
      if (begin == Kinds::kFromOther || &type != &effect::stribeck_friction) continue;
      // From a curve that is level no slope leads far.
      for (const double rate_rad_s : {0.1, 0.4}) {
        const Candidate level = kinds.back();
        Effect bent = *fitted_effect(level);
        bent.at("friction_nm") *= 0.5;
        bent.at("breakaway_ratio") = 2;
        bent.at("stribeck_rate_rad_s") = rate_rad_s;
        kinds.push_back(level);
        std::ranges::copy(bent.values, kinds.back().fit.x.end() - std::ssize(bent.values));
      }
    }
    return kinds;
  }

  const ComparisonSetting& alone_;
  const Comparison& singles_;
  const AttributionInput& input_;
  std::optional<CausePair> best_;
  mutable std::optional<CausePair> out_of_place_;
  mutable std::mutex out_of_place_mutex_;
};

}  // namespace

std::optional<Effect> fitted_beside(std::optional<Effect> first, const Candidate& second) {
  if (!first) return first;
  const auto behind = std::ssize(fitted_effect(second).value_or(Effect()).values);
  std::copy_n(second.fit.x.end() - behind - std::ssize(first->values), first->values.size(), first->values.begin());
  return first;
}

std::optional<CausePair> best_pair(const ComparisonSetting& alone, const Comparison& singles,
                                   const AttributionInput& input) {
  return PairSearch(alone, singles, input).best();
}

}  // namespace steerid
