// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <span>

#include "gap/attribution/verdict_ids.hpp"
#include "gap/comparison/wheel_shift.hpp"
#include "gap/diagnosis/attributed_record.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/final_fit.hpp"
#include "gap/diagnosis/held_out_runs.hpp"
#include "gap/diagnosis/localisation.hpp"
#include "gap/diagnosis/next_experiment.hpp"
#include "gap/diagnosis/ranking.hpp"
#include "gap/diagnosis/set_answer.hpp"
#include "gap/diagnosis/shrinkage.hpp"
#include "gap/diagnosis/stand_in.hpp"
#include "gap/diagnosis/time_limit.hpp"
#include "gap/diagnosis/together.hpp"
#include "gap/hypotheses/hypotheses.hpp"
#include "gap/likelihood/noise_shape.hpp"
#include "gap/model/floor_rms.hpp"
#include "gap/model/floor_runs.hpp"
#include "gap/model/restarted_run.hpp"
#include "gap/model/slow_torque.hpp"
#include "gap/pairs/pair_acceptance.hpp"
#include "gap/preparation/prepared_record.hpp"
#include "log/bad_input.hpp"
#include "log/resample.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

/// Everything that goes on from the question "what is it?" to "what does the simulation become?".
class Diagnosing {
 public:
  Diagnosing(const Record& log, const Simulation& simulation, const DiagnoseOptions& options, std::size_t turn)
      : options_(options), simulation_(simulation), prepared_(log, simulation, options.without, turn) {}

  Diagnosis answer() {
    options_.at_part(0.15);
    attribute_first();
    options_.at_part(0.6);
    add_further_causes();
    options_.at_part(0.8);
    build_simulations();
    measure();
    return finished();
  }

  /// One of several records of a wheel: the search alone; what it finds is joined with that of the others.
  SetAnswer& searched_together() {
    together_ = true;
    return by_sets_.emplace(prepared_, simulation_, options_);
  }

  /// What the records say together, on this one.
  void measure_together() {
    name_changes();
    out_.causes.clear();
    out_.inclusion.clear();
    build_simulations();
    measure();
  }

  /// The changes without which this record's held-out part is simulated no worse.
  [[nodiscard]] std::vector<const EffectType*> idle_changes() const {
    const double with = held_out_nrmse(out_.series.with_effect_rad);
    std::vector<const EffectType*> idle;
    for (const NamedChange& change : named_) {
      if (hypothesis_of(*change.effect.type) == nullptr) continue;  // a slow torque's course was taken from the record
      Simulation rest = out_.with_effect;
      revert(change, rest);
      if (held_out_nrmse(run(rest)) < with) idle.push_back(change.effect.type);
    }
    return idle;
  }

  Diagnosis finished() {
    if (by_sets_) {
      out_.next_experiment.why = "No probe is worked out for a simulation that has effects.";
    } else {
      out_.next_experiment = next_experiment(out_, first_.comparison, prepared_, simulation_);
    }
    if (options_.figures) localise(out_, prepared_, floor_);
    out_.notes.insert(out_.notes.begin(), prepared_.notes.begin(), prepared_.notes.end());
    options_.at_part(1);
    return std::move(out_);
  }

  /// Whether the part that reports holds something that the rest does not show, such as a single absence: what was seen
  /// is explained down to the floor without any effect, and the held-out part is far from it.
  [[nodiscard]] bool reports_something_new(const Diagnosis& answer) const {
    constexpr double kFar = 4;  // times the floor; a slow torque's chance is half of that
    if (by_sets_ || prepared_.drifts || !prepared_.defects.found.empty() || answer.only_the_loop_holds) return false;
    const bool named = names_effect(answer.verdict);
    const bool far = answer.gap.with_effect_nrmse > kFar * answer.gap.floor_nrmse;
    return far && !named && likeliest(first_).excess < kWorthAName;
  }

 private:
  void attribute_first() {
    if (!simulation_.effects.empty()) {
      by_sets_.emplace(prepared_, simulation_, options_);
      name_changes();
      return;
    }
    first_ = attributed_record(prepared_, simulation_, options_);
    // What a repair leaves is no second effect's.
    if (prepared_.defects.found.empty() && time_for("the search for two effects at once", options_, out_.notes)) {
      pair_ = pair_instead(comparison_setting(prepared_, simulation_, options_, simulation_.effects), first_.comparison,
                           first_.input, first_.probability);
    }
    const std::vector<Evidence>& all = first_.input.all;
    out_.ranking = ranking_of(first_.input, first_.probability, prepared_.defects.found);
    out_.verdict = out_.ranking.front().id;
    out_.equivalent = equivalent_to(out_.verdict, out_.ranking, first_.input);
    if (pair_) {
      std::erase(out_.equivalent, pair_->first);
      std::erase(out_.equivalent, pair_->second.id);
    }
    for (const RecordDefect& defect : prepared_.defects.found) causes_.push_back(defect.effect);
    out_.evidence = all;
    out_.noise_is_none =
        out_.verdict == "unknown" && first_.input.noise_departure > kNoNoise &&
        std::ranges::any_of(all, [](const Evidence& one) { return !names_effect(one.id) && one.excess < kWorthAName; });
  }

  /// Takes what the sets say; again after a change was dropped.
  void name_changes() {
    out_.ranking = by_sets_->ranking(prepared_.defects.found);
    out_.verdict = by_sets_->verdict();
    causes_.clear();
    named_.clear();
    slow_ = SlowTorque::kFloor;
    for (const RecordDefect& defect : prepared_.defects.found) {
      const auto known = std::ranges::find(simulation_.effects, defect.effect.type, &Effect::type);
      if (known != simulation_.effects.end()) continue;
      causes_.push_back(defect.effect);
      named_.push_back({.kind = ChangeKind::kAdd, .effect = defect.effect, .was = {}, .probability = 0.99});
    }
    for (NamedChange& change : by_sets_->changes()) {
      if (change.effect.type == &effect::unmeasured_torque) slow_ = SlowTorque::kCause;
      named_.push_back(std::move(change));
    }
    if (!names_effect(out_.verdict) && !named_.empty()) out_.verdict = std::string(named_.front().effect.type->id);
    final_ = by_sets_->final_fit();
  }

  /// An effect that was found beside the record's defects, or the verdict itself; then further ones as long as the
  /// blocks that choose gain by it.
  void add_further_causes() {
    if (by_sets_) return;
    if (pair_) {
      add_pair();
    } else {
      std::string next = names_effect(out_.verdict) ? out_.verdict : "";
      if (!causes_.empty()) {
        next = second_beside_defects();
      } else if (out_.verdict == "unknown") {
        next = standing_in();
        out_.surrogate = !next.empty();
      }
      if (next.empty()) return;
      add(first_.comparison.at(next));
      if (out_.surrogate) return;
    }
    if (!pair_ || slow_ == SlowTorque::kCause || final_->excess < kWorthAName) return;
    if (!time_for("the search for a third effect", options_, out_.notes)) return;
    std::vector<Effect> present = simulation_.effects;
    std::ranges::copy_if(causes_, std::back_inserter(present), is_fitted);
    const AttributedRecord beside = attributed_beside(prepared_, simulation_, options_, std::move(present));
    const std::string next = further_cause(beside);
    if (!next.empty()) add(beside.comparison.at(next));
  }

  void add_pair() {
    if (pair_->first_effect) causes_.push_back(*pair_->first_effect);
    slow_ = pair_->slow;
    add(pair_->second);
    const auto place = [&](std::string_view id) {
      return std::ranges::find(causes_, id, [](const Effect& one) { return one.type->id; });
    };
    const auto other = place(pair_->leading == pair_->first ? pair_->second.id : pair_->first);
    const auto leading = place(pair_->leading);
    if (other < leading && leading != causes_.end()) std::iter_swap(other, leading);
  }

  /// What stands in for something unknown: what would explain it if J, B and C were as it needs them, or what comes
  /// nearest; empty where nothing brings a free run nearer.
  [[nodiscard]] std::string standing_in() {
    const std::string probable = best_effect(out_.ranking, first_.comparison);
    if (probable.empty()) return probable;
    const Evidence& by = *std::ranges::find(first_.input.all, probable, &Evidence::id);
    out_.base_out_of_place = by.excess < kWorthAName && by.shift_at_least > kOutOfPlace;
    return out_.base_out_of_place ? probable : stand_in(prepared_, simulation_, first_.comparison, probable);
  }

  /// The effect found beside the record's own defects. What their repair leaves lies above the floor and no effect
  /// explains it, so that `unknown` has no say here: the likeliest effect is asked what it gains.
  [[nodiscard]] std::string second_beside_defects() const {
    const Evidence& by = likeliest(first_);
    const Evidence& refit = first_.input.all[1];
    // What a plateau of seconds hid is slow, and what its repair leaves passes for a torque that nobody measured. One
    // that is there leaves nothing.
    constexpr double kReached = 1.15;
    if (by.id == "unmeasured_torque" && !prepared_.defects.hidden.empty() && by.excess > kReached) return {};
    const bool rounded = prepared_.defects.found.size() == 1 && prepared_.spectral->spectra.step_rad() > 0;
    const bool gains = rounded ? gains_beside_rounding(refit, by) : gains_beside_defects(refit, by);
    return names_effect(by.id) && gains ? by.id : std::string();
  }

  [[nodiscard]] std::string further_cause(const AttributedRecord& beside) const {
    const Evidence& by = likeliest(beside);
    return names_effect(by.id) && gains_enough(final_->excess, final_->nats, by) ? by.id : std::string();
  }

  [[nodiscard]] static bool is_fitted(const Effect& effect) {
    const std::string_view id = effect.type->id;
    return id != "sample_loss" && id != "coarse_quantization" && id != "torque_saturation" && id != "unmeasured_torque";
  }

  /// Refits with the cause on all that was seen, and keeps the result as the present state.
  void add(const Candidate& candidate) {
    std::vector<Effect> fitted;
    std::ranges::copy_if(causes_, std::back_inserter(fitted), is_fitted);
    if (candidate.id == "unmeasured_torque") slow_ = SlowTorque::kCause;
    final_ = final_fit(prepared_, simulation_, candidate, fitted, slow_);
    std::erase_if(causes_, is_fitted);
    causes_.insert(causes_.end(), final_->effects.begin() + static_cast<std::ptrdiff_t>(simulation_.effects.size()),
                   final_->effects.end());
  }

  void build_simulations() {
    if (by_sets_) {
      build_by_sets();
      return;
    }
    const FinalFit linear =
        final_fit(prepared_, simulation_, first_.comparison.at("parameters"), {}, SlowTorque::kFloor);
    out_.refit = simulation_;
    // Where free runs drift, none over the whole record can say which wheel comes closest.
    out_.refit.wheel = simulation_.effects.empty() && !prepared_.drifts ? prepared_.closest : linear.wheel;
    out_.refit.effects = linear.effects;
    last_ = final_ ? *final_ : linear;
    floor_ = last_.floor;
    if (slow_ == SlowTorque::kFloor) {  // a model that misses something would have it in its slow torque
      floor_.slow_variance = std::min(floor_.slow_variance, std::pow(0.022 * prepared_.spectral->applied_rms_nm, 2));
    }
    out_.with_effect = out_.refit;
    out_.with_effect.wheel = out_.verdict == "none" ? simulation_.wheel : last_.wheel;
    out_.with_effect.effects =
        final_ ? std::vector<Effect>(simulation_.effects.begin(), simulation_.effects.end()) : linear.effects;
    if (out_.verdict == "none") out_.with_effect.effects = simulation_.effects;
    out_.base = {last_.inertia_kgm2, last_.damping_nms_per_rad, last_.stiffness_nm_per_rad};
    if (out_.verdict == "unknown") {
      allow_for_given();
      if (!final_) out_.with_effect.wheel = out_.refit.wheel;  // nothing brings it nearer
    }
    for (const Effect& effect : causes_) out_.with_effect.effects.push_back(effect);
    add_slow_torque();
  }

  void build_by_sets() {
    const FittedSet& refit = by_sets_->refit();
    out_.refit = simulation_;
    out_.refit.wheel = wheel_of(refit.fit.x);
    last_ = *final_;
    floor_ = last_.floor;
    if (slow_ == SlowTorque::kFloor) {  // a model that misses something would have it in its slow torque
      floor_.slow_variance = std::min(floor_.slow_variance, std::pow(0.022 * prepared_.spectral->applied_rms_nm, 2));
    }
    out_.base = {last_.inertia_kgm2, last_.damping_nms_per_rad, last_.stiffness_nm_per_rad};
    out_.with_effect = simulation_;
    if (out_.verdict == "none" || out_.verdict == "unknown") {
      if (out_.verdict == "unknown") out_.with_effect = out_.refit;
      return;
    }
    out_.with_effect.wheel = last_.wheel;
    if (out_.verdict == "parameters") return;
    for (const NamedChange& change : named_) apply(change, out_.with_effect);
    // What is no size of a given effect is fitted with the rest.
    for (const Effect& fitted : last_.effects) {
      const auto same = std::ranges::find(out_.with_effect.effects, fitted.type, &Effect::type);
      if (same != out_.with_effect.effects.end()) *same = fitted;
    }
    add_slow_torque();
  }

  /// Makes a change of a simulation; an unmeasured torque comes last, when all else is known.
  static void apply(const NamedChange& change, Simulation& simulation) {
    const EffectType* type = change.effect.type;
    if (type == &effect::unmeasured_torque) return;
    if (change.kind != ChangeKind::kAdd) {
      std::erase_if(simulation.effects, [&](const Effect& one) { return one.type == type; });
    }
    if (change.kind != ChangeKind::kRemove) simulation.effects.push_back(change.effect);
  }

  /// Undoes one.
  static void revert(const NamedChange& change, Simulation& simulation) {
    std::erase_if(simulation.effects, [&](const Effect& one) { return one.type == change.effect.type; });
    if (change.was) simulation.effects.push_back(*change.was);
  }

  /// Drops a change without which the held-out part is simulated no worse. True if there was one.
  bool drop_idle_change() {
    const std::vector<const EffectType*> idle = idle_changes();
    if (!idle.empty()) by_sets_->drop(*idle.front());
    return !idle.empty();
  }

  /// A stand-in's J, B and C are no better known than those that the simulation had: nothing that explains the record
  /// speaks for moving them.
  void allow_for_given() {
    const auto reach = [](BoundedValue& found, double given) {
      found.low = std::min(found.low, given);
      found.high = std::max(found.high, given);
    };
    reach(out_.base.inertia_kgm2, simulation_.wheel.inertia_kgm2);
    reach(out_.base.damping_nms_per_rad, simulation_.wheel.damping_nms_per_rad);
    reach(out_.base.stiffness_nm_per_rad, simulation_.wheel.stiffness_nm_per_rad);
  }

  /// The time course of an unmeasured torque, where that is the cause.
  void add_slow_torque() {
    if (slow_ != SlowTorque::kCause) return;
    std::vector<double> rest = run(out_.with_effect);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = prepared_.defects.repaired.angle_rad[i] - rest[i];
    std::vector<char> use(rest.size(), 1);
    for (const Block& block : prepared_.blocks) {
      if (block.role != Block::Role::kReport) continue;
      for (std::size_t i = block.first; i < block.first + block.count; ++i) use[i] = i % 2 == 0 ? 1 : 0;
    }
    Effect effect = slow_torque(prepared_.record, out_.with_effect.wheel, rest, use, floor_);
    Simulation beside = out_.with_effect;  // of the repaired record
    std::erase_if(beside.effects, [](const Effect& one) { return !is_fitted(one); });
    if (!beside.effects.empty() && !prepared_.drifts) {
      effect = slow_torque_by_runs(prepared_.defects.repaired, prepared_.stretches, beside, effect, use, floor_);
    }
    out_.with_effect.effects.push_back(effect);
    causes_.push_back(std::move(effect));
    // Its time course is known now: it is no part of the floor any more.
    floor_.slow_variance = 0;
  }

  void measure() {
    const Record& record = prepared_.record;
    GapSeries& series = out_.series;
    series.time_s = record.time_s;
    series.measured_rad = record.angle_rad;
    series.held_out.assign(record.size(), 0);
    for (const Block& block : prepared_.blocks) {
      if (block.role != Block::Role::kReport) continue;
      std::fill_n(series.held_out.begin() + static_cast<std::ptrdiff_t>(block.first), block.count, char{1});
    }
    series.sim_rad = run(simulation_);
    series.refit_rad = run(out_.refit);
    if (by_sets_ && held_out_nrmse(series.refit_rad) > held_out_nrmse(series.sim_rad)) {  // other J, B, C help nobody
      out_.refit = simulation_;
      series.refit_rad = series.sim_rad;
    }
    series.with_effect_rad = run(out_.with_effect);
    double quantum = 0;
    for (const Effect& effect : causes_) {
      if (effect.type == &effect::coarse_quantization) quantum = effect.values[0];
    }
    if (by_sets_ && !together_ && drop_idle_change()) {
      name_changes();
      build_simulations();
      measure();
      return;
    }
    const bool fitted = out_.verdict != "none" && (final_ || out_.verdict != "unknown");
    const HeldOutRuns held_out{prepared_, out_.with_effect, series.with_effect_rad, series.held_out};
    out_.gap = shrinkage({.record = record,
                          .blocks = prepared_.blocks,
                          .sim_rad = series.sim_rad,
                          .refit_rad = series.refit_rad,
                          .with_effect_rad = series.with_effect_rad,
                          .gain = prepared_.drifts ? held_gain(within_run(out_.with_effect.wheel, held_out_run_s()))
                                                   : gain_with(out_.with_effect.wheel, out_.with_effect.effects),
                          .floor = floor_,
                          .floor_rad = floor_of_runs(quantum),
                          .quantum_rad = quantum,
                          .unsure_rad2 = fitted ? moved_by_numbers_rad2(held_out, last_) : std::vector<double>(),
                          .every_second = slow_ == SlowTorque::kCause,
                          .draws = options_.bootstrap_draws,
                          .seed = options_.seed});
    if (!causes_.empty() && prepared_.whittle->white().at_most && !with_effect_holds_itself()) {
      out_.only_the_loop_holds = true;
      out_.gap.closed_fraction.value = std::numeric_limits<double>::quiet_NaN();
      out_.notes.emplace_back(
          "the wheel does not hold itself with what was found, only the loop holds it: its free run leaves the record, "
          "and cannot say how far the gap closes");
    }
    describe_causes();
  }

  [[nodiscard]] bool with_effect_holds_itself() const {
    return holds_itself(prepared_.record, prepared_.stretches, out_.with_effect.wheel, out_.with_effect.effects,
                        out_.with_effect.torque_between_samples);
  }

  /// The floor behind causes that are not linear: friction holds most of what the noise would move a free wheel by. A
  /// rounded angle hides its noise.
  [[nodiscard]] std::optional<double> floor_of_runs(double quantum_rad) const {
    if (out_.with_effect.effects.empty() || quantum_rad > 0) return std::nullopt;
    return floor_by_runs_rad(out_.with_effect, prepared_.record, prepared_.stretches, out_.series.with_effect_rad,
                             floor_, options_.seed);
  }

  [[nodiscard]] double probability_of(std::string_view id) const {
    return std::ranges::find(out_.ranking, id, &RankedEffect::id)->probability;
  }

  /// What each cause closes: free runs with the causes up to it.
  void describe_causes() {
    const double told_at_least =
        std::max(out_.gap.refit_nrmse - out_.gap.floor_nrmse, kFloorKnownTo * out_.gap.floor_nrmse);
    const double left = std::max(out_.gap.with_effect_nrmse - out_.gap.floor_nrmse, 0.0);
    out_.unexplained.complete = left <= kFloorKnownTo * out_.gap.floor_nrmse;
    if (!out_.unexplained.complete) out_.unexplained.share_of_gap = std::min(left / told_at_least, 1.0);
    if (by_sets_) {
      describe_changes();
      return;
    }
    for (const RankedEffect& one : out_.ranking) {
      if (names_effect(one.id)) out_.inclusion.push_back({one.id, ChangeKind::kAdd, one.probability, {}});
    }
    if (!names_effect(out_.verdict) && !out_.surrogate) return;
    const double floor = out_.gap.floor_nrmse;
    const double told = std::max({out_.gap.refit_nrmse - floor, kFloorKnownTo * floor, 1e-9});
    double before = out_.gap.refit_nrmse;
    Simulation partial = out_.with_effect;
    partial.effects = simulation_.effects;
    for (std::size_t i = 0; i < causes_.size(); ++i) {
      partial.effects.push_back(causes_[i]);
      Cause cause{causes_[i], {}, 0, ChangeKind::kAdd, probability_of(causes_[i].type->id), {}};
      const bool last = i + 1 == causes_.size();
      const double after = last ? out_.gap.with_effect_nrmse : held_out_nrmse(run(partial));
      cause.closes = (before - after) / told;
      before = after;
      if (final_) {
        const auto found =
            std::ranges::find_if(final_->effects, [&](const Effect& e) { return e.type == causes_[i].type; });
        if (found != final_->effects.end()) {
          cause.parameters = final_->parameters[static_cast<std::size_t>(found - final_->effects.begin())];
        }
      }
      out_.causes.push_back(std::move(cause));
    }
  }

  /// The changes in the order in which they were named, the one without which most is left first.
  void describe_changes() {
    for (const ChangeInclusion& one : by_sets_->inclusion().changes) {
      out_.inclusion.push_back({std::string(one.type->id), one.kind, one.probability, one.features});
    }
    std::vector<std::pair<double, NamedChange>> order;
    for (const NamedChange& change : named_) {
      Simulation rest = out_.with_effect;
      revert(change, rest);
      order.emplace_back(held_out_nrmse(run(rest)), change);
    }
    std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
    const double floor = out_.gap.floor_nrmse;
    const double told = std::max({out_.gap.refit_nrmse - floor, kFloorKnownTo * floor, 1e-9});
    double before = out_.gap.refit_nrmse;
    Simulation partial = simulation_;
    partial.wheel = out_.with_effect.wheel;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const NamedChange& change = order[i].second;
      apply(change, partial);
      Cause cause{change.effect, {}, 0, change.kind, change.probability, change.was};
      const double after = i + 1 == order.size() ? out_.gap.with_effect_nrmse : held_out_nrmse(run(partial));
      cause.closes = (before - after) / told;
      before = after;
      const auto found =
          std::ranges::find_if(last_.effects, [&](const Effect& e) { return e.type == change.effect.type; });
      if (change.kind != ChangeKind::kRemove && found != last_.effects.end()) {
        cause.parameters = last_.parameters[static_cast<std::size_t>(found - last_.effects.begin())];
      }
      out_.causes.push_back(std::move(cause));
    }
    if (!out_.causes.empty() && names_effect(out_.verdict)) {
      out_.verdict = std::string(out_.causes.front().effect.type->id);
    }
  }

  /// How long a run lasts on the part that reports, where it begins anew there.
  [[nodiscard]] double held_out_run_s() const {
    const auto reports = [](const Block& block) { return block.role == Block::Role::kReport; };
    return static_cast<double>(std::ranges::find_if(prepared_.blocks, reports)->count) / kResampledRateHz;
  }

  [[nodiscard]] std::vector<double> run(const Simulation& simulation) const {
    return restarted_run(simulation, prepared_.record, prepared_.stretches);
  }

  [[nodiscard]] double held_out_nrmse(const std::vector<double>& angle) const {
    const std::vector<double>& measured = prepared_.record.angle_rad;
    double mean = 0;
    double power = 0;
    double count = 0;
    for (std::size_t i = 0; i < measured.size(); ++i) {
      if (out_.series.held_out[i] == 0) continue;
      mean += measured[i];
      power += measured[i] * measured[i];
      count += 1;
    }
    mean /= count;
    return std::sqrt(held_out_square(measured, angle, out_.series.held_out)) /
           std::sqrt(std::max(power / count - mean * mean, 1e-24));
  }

  const DiagnoseOptions& options_;
  const Simulation& simulation_;
  PreparedRecord prepared_;
  Diagnosis out_;
  AttributedRecord first_;
  std::optional<CausePair> pair_;
  std::optional<SetAnswer> by_sets_;  ///< where the simulation has effects
  bool together_ = false;             ///< with other records of the wheel
  std::vector<NamedChange> named_;
  std::vector<Effect> causes_;
  std::optional<FinalFit> final_;
  FinalFit last_;  ///< that, or the linear wheel's
  SlowTorque slow_ = SlowTorque::kFloor;
  NoiseFloor floor_;
};

}  // namespace

Diagnosis diagnose(const Record& record, const Simulation& simulation, const DiagnoseOptions& options) {
  Diagnosing first(record, simulation, options, 0);
  Diagnosis answer = first.answer();
  if (!first.reports_something_new(answer)) return answer;
  constexpr const char* kOnceMore =
      "a second look, as what was held out holds something that the rest of the record does not show,";
  if (!time_for(kOnceMore, options, answer.notes)) return answer;
  Diagnosing second(record, simulation, options, 1);
  Diagnosis again = second.answer();
  if (second.reports_something_new(again)) return answer;
  again.notes.emplace_back(
      "what was held out at first holds something that the rest of the record does not show: the parts have changed "
      "places, and what reports now has fitted before");
  return again;
}

Together diagnose_together(std::span<const NamedRecord> records, const Simulation& simulation,
                           const DiagnoseOptions& options) {
  std::vector<std::unique_ptr<Diagnosing>> all;
  std::vector<SetAnswer*> answers;
  for (const NamedRecord& one : records) {
    options.at_part(0.7 * static_cast<double>(all.size()) / static_cast<double>(records.size()));
    try {
      all.push_back(std::make_unique<Diagnosing>(one.record, simulation, options, 0));
      answers.push_back(&all.back()->searched_together());
    } catch (const BadInput& error) {
      throw BadInput(fmt::format("{}: {}", one.name, error.what()));
    }
  }
  SetAnswer::join(answers);
  // A change is dropped that no record's held-out part needs.
  for (bool dropped = true; dropped;) {
    options.at_part(0.8);
    std::vector<const EffectType*> idle;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i]->measure_together();
      const std::vector<const EffectType*> own = all[i]->idle_changes();
      if (i == 0) idle = own;
      std::erase_if(idle, [&](const EffectType* type) { return std::ranges::find(own, type) == own.end(); });
    }
    dropped = !idle.empty();
    for (SetAnswer* answer : answers) {
      if (dropped) answer->drop(*idle.front());
    }
  }
  Together out;
  for (const auto& one : all) out.records.push_back(one->finished());
  out.numbers = shared_numbers(out.records);
  for (const SharedNumber& number : out.numbers) {
    if (number.differs) out.records.front().notes.push_back(difference_words(number, records));
  }
  return out;
}

}  // namespace steerid
