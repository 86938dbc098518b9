// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/diagnosing.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gap/attribution/verdict_ids.hpp"
#include "gap/comparison/wheel_shift.hpp"
#include "gap/diagnosis/bare_next_experiment.hpp"
#include "gap/diagnosis/localisation.hpp"
#include "gap/diagnosis/next_experiment.hpp"
#include "gap/diagnosis/ranking.hpp"
#include "gap/diagnosis/stand_in.hpp"
#include "gap/diagnosis/time_limit.hpp"
#include "gap/likelihood/noise_shape.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

bool is_fitted(const Effect& effect) {
  const std::string_view id = effect.type->id;
  return id != "sample_loss" && id != "coarse_quantization" && id != "torque_saturation" && id != "unmeasured_torque";
}

}  // namespace

Diagnosing::Diagnosing(const Record& log, const Simulation& simulation, const DiagnoseOptions& options,
                       std::size_t turn)
    : options_(options), simulation_(simulation), prepared_(log, simulation, options.without, turn) {}

Diagnosis Diagnosing::answer() {
  options_.at_part(0.15);
  attribute_first();
  options_.at_part(0.6);
  add_further_causes();
  options_.at_part(0.8);
  build_simulations();
  measure();
  return finished();
}

SetAnswer& Diagnosing::searched_together() {
  together_ = true;
  return by_sets_.emplace(prepared_, simulation_, options_);
}

void Diagnosing::measure_together() {
  name_changes();
  out_.causes.clear();
  out_.inclusion.clear();
  build_simulations();
  measure();
}

Diagnosis Diagnosing::finished() {
  if (!time_for("the proposal of a probe", options_, out_.notes)) {
    out_.next_experiment.why = "No probe was worked out within the time limit.";
  } else if (by_sets_) {
    out_.next_experiment = next_experiment(*by_sets_, prepared_);
  } else {
    out_.next_experiment = next_experiment(out_, first_.comparison, prepared_, simulation_);
  }
  if (options_.figures) localise(out_, prepared_, floor_);
  out_.notes.insert(out_.notes.begin(), prepared_.notes.begin(), prepared_.notes.end());
  options_.at_part(1);
  return std::move(out_);
}

bool Diagnosing::reports_something_new(const Diagnosis& answer) const {
  constexpr double kFar = 4;  // times the floor; a slow torque's chance is half of that
  if (by_sets_ || prepared_.drifts || !prepared_.defects.found.empty() || answer.only_the_loop_holds) return false;
  const bool named = names_effect(answer.verdict);
  const bool far = answer.gap.with_effect_nrmse > kFar * answer.gap.floor_nrmse;
  return far && !named && likeliest(first_).excess < kWorthAName;
}

void Diagnosing::attribute_first() {
  if (!simulation_.effects.empty()) {
    by_sets_.emplace(prepared_, simulation_, options_);
    name_changes();
    return;
  }
  first_ = attributed_record(prepared_, simulation_, options_);
  // What a repair leaves is no second effect's.
  if (prepared_.defects.found.empty() && time_for("the search for two effects at once", options_, out_.notes)) {
    pair_ = pair_instead(comparison_setting(prepared_, simulation_, options_, {}), first_.comparison, first_.input,
                         first_.probability);
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

void Diagnosing::name_changes() {
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

void Diagnosing::add_further_causes() {
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
  std::vector<Effect> present;
  std::ranges::copy_if(causes_, std::back_inserter(present), is_fitted);
  const AttributedRecord beside = attributed_beside(prepared_, simulation_, options_, std::move(present));
  const std::string next = further_cause(beside);
  if (!next.empty()) add(beside.comparison.at(next));
}

void Diagnosing::add_pair() {
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

std::string Diagnosing::standing_in() {
  const std::string probable = best_effect(out_.ranking, first_.comparison);
  if (probable.empty()) return probable;
  const Evidence& by = *std::ranges::find(first_.input.all, probable, &Evidence::id);
  out_.base_out_of_place = by.excess < kWorthAName && by.shift_at_least > kOutOfPlace;
  return out_.base_out_of_place ? probable : stand_in(prepared_, simulation_, first_.comparison, probable);
}

std::string Diagnosing::second_beside_defects() const {
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

std::string Diagnosing::further_cause(const AttributedRecord& beside) const {
  const Evidence& by = likeliest(beside);
  return names_effect(by.id) && gains_enough(final_->excess, final_->nats, by) ? by.id : std::string();
}

void Diagnosing::add(const Candidate& candidate) {
  std::vector<Effect> fitted;
  std::ranges::copy_if(causes_, std::back_inserter(fitted), is_fitted);
  if (candidate.id == "unmeasured_torque") slow_ = SlowTorque::kCause;
  final_ = final_fit(prepared_, simulation_, candidate, fitted, slow_);
  std::erase_if(causes_, is_fitted);
  causes_.insert(causes_.end(), final_->effects.begin(), final_->effects.end());
}

void Diagnosing::build_simulations() {
  if (by_sets_) {
    build_by_sets();
    return;
  }
  const FinalFit linear = final_fit(prepared_, simulation_, first_.comparison.at("parameters"), {}, SlowTorque::kFloor);
  out_.refit = simulation_;
  // Where free runs drift, none over the whole record can say which wheel comes closest.
  out_.refit.wheel = prepared_.drifts ? linear.wheel : prepared_.closest;
  rest_on(final_ ? *final_ : linear);
  out_.with_effect = out_.refit;
  out_.with_effect.wheel = out_.verdict == "none" ? simulation_.wheel : last_.wheel;
  if (out_.verdict == "unknown") {
    allow_for_given();
    if (!final_) out_.with_effect.wheel = out_.refit.wheel;  // nothing brings it nearer
  }
  for (const Effect& effect : causes_) out_.with_effect.effects.push_back(effect);
  add_slow_torque();
}

void Diagnosing::build_by_sets() {
  const FittedSet& refit = by_sets_->refit();
  out_.refit = simulation_;
  out_.refit.wheel = wheel_of(refit.fit.x);
  rest_on(*final_);
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

void Diagnosing::rest_on(const FinalFit& last) {
  last_ = last;
  floor_ = last_.floor;
  if (slow_ == SlowTorque::kFloor) {  // a model that misses something would have it in its slow torque
    floor_.slow_variance = std::min(floor_.slow_variance, std::pow(0.022 * prepared_.spectral->applied_rms_nm, 2));
  }
  out_.base = {last_.inertia_kgm2, last_.damping_nms_per_rad, last_.stiffness_nm_per_rad};
}

void Diagnosing::allow_for_given() {
  const auto reach = [](BoundedValue& found, double given) {
    found.low = std::min(found.low, given);
    found.high = std::max(found.high, given);
  };
  reach(out_.base.inertia_kgm2, simulation_.wheel.inertia_kgm2);
  reach(out_.base.damping_nms_per_rad, simulation_.wheel.damping_nms_per_rad);
  reach(out_.base.stiffness_nm_per_rad, simulation_.wheel.stiffness_nm_per_rad);
}

void Diagnosing::add_slow_torque() {
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

}  // namespace steerid
