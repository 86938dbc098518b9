// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/diagnosing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "gap/diagnosis/localisation.hpp"
#include "gap/diagnosis/named_change.hpp"
#include "gap/diagnosis/next_experiment.hpp"
#include "gap/diagnosis/time_limit.hpp"
#include "gap/diagnosis/verdict_ids.hpp"
#include "gap/hypotheses/slow_share.hpp"
#include "gap/model/slow_torque.hpp"
#include "gap/sets/set_search.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

std::string steering_words(double lowest_hz, const GapSizes& gap) {
  return fmt::format(
      "the driver steers by a torque that is in no column: angle and torque are compared, and shown, from {:g} Hz on, "
      "where what is measured moves the wheel; of that motion {:.0f} % is noise, with what he does beyond {:g} Hz, and "
      "hides what moves the wheel by less; friction, backlash, a spring that bends, a weight, a ripple and an offset "
      "cannot be told there",
      lowest_hz, 100 * gap.floor_nrmse, lowest_hz);
}

}  // namespace

Diagnosing::Diagnosing(const Record& log, const Simulation& simulation, const DiagnoseOptions& options,
                       std::size_t turn, const AngleClock& clock)
    : options_(options),
      simulation_(simulation),
      prepared_(log, simulation, options.without, turn, options.origin_s, options.remainder, clock),
      by_sets_(prepared_, simulation, options) {
  GapSeries& series = out_.series;
  series.time_s = prepared_.log_stamps_s();
  series.measured_rad = prepared_.record.angle_rad;
  series.held_out.assign(prepared_.record.size(), 0);
  for (const Block& block : prepared_.blocks) {
    if (block.role != Block::Role::kReport) continue;
    std::fill_n(series.held_out.begin() + static_cast<std::ptrdiff_t>(block.first), block.count, char{1});
  }
}

Diagnosis Diagnosing::answer() {
  options_.at_part(0.15);
  by_sets_.search();
  options_.at_part(0.8);
  measure();
  return finished();
}

SetAnswer& Diagnosing::searched_together() {
  together_ = true;
  by_sets_.search();
  return by_sets_;
}

std::optional<ClockError> Diagnosing::clock_error(ClockError::Course course) const {
  const SetSetting& setting = by_sets_.setting();
  return clock_error_left(by_sets_.searched() ? by_sets_.own(by_sets_.judged().answer()) : with_free_wheel(setting),
                          SetFitter(setting), course);
}

void Diagnosing::say_what_this_record_alone_tells() {
  const std::optional<FinalFit> alone = by_sets_.fit_alone();
  if (!alone) return;
  for (Cause& cause : out_.causes) {
    const auto found = std::ranges::find(alone->at.effects, cause.effect.type, &Effect::type);
    if (found == alone->at.effects.end() || cause.parameters.empty()) continue;
    cause.alone = alone->parameters[static_cast<std::size_t>(found - alone->at.effects.begin())];
  }
}

Diagnosis Diagnosing::finished() {
  say_what_this_record_alone_tells();
  if (out_.only_the_loop_holds) {
    out_.notes.emplace_back(
        "the wheel does not hold itself with what was found, only the loop holds it: its free run leaves the record, "
        "and cannot say how far the gap closes");
  }
  if (!out_.not_credible.empty()) {
    out_.next_experiment.why = "No probe tells anything before the record's columns are right.";
  } else if (!time_for("the proposal of a probe", options_, out_.notes)) {
    out_.next_experiment.why = "No probe was worked out within the time limit.";
  } else if (out_.verdict == "unknown") {  // a surrogate is none of the rivals
    out_.next_experiment.why = "Nothing explains this record, so that there are no rivals for a probe to tell apart.";
  } else {
    out_.next_experiment = next_experiment(by_sets_, prepared_);
  }
  const bool timed = std::ranges::any_of(out_.causes, [](const Cause& cause) {
    const Hypothesis* hypothesis = hypothesis_of(*cause.effect.type);
    return hypothesis != nullptr && hypothesis->timed();
  });
  if (timed && prepared_.origin_s != 0) {
    out_.notes.push_back(fmt::format("instants of effects count from {} s of the log's clock", prepared_.origin_s));
  }
  for (const Cause& cause : out_.causes) {
    if (cause.effect.type->same_motion_as == nullptr) continue;
    std::vector<std::string> others;
    for (const Effect& other : cause.effect.type->same_motion_as(cause.effect.values)) {
      others.push_back(fmt::format("{} ({} {:.3g})", other.type->id, other.type->parameters[0].name, other.values[0]));
    }
    out_.notes.push_back(fmt::format("no record tells {} from {}: both move the wheel in the same way",
                                     cause.effect.type->id, fmt::join(others, " beside ")));
  }
  if (prepared_.lowest_hz > 0) out_.notes.push_back(steering_words(prepared_.lowest_hz, out_.gap));
  if (options_.figures) localise(out_, prepared_, floor_);
  put_remainder_back();
  out_.notes.insert(out_.notes.begin(), prepared_.notes.begin(), prepared_.notes.end());
  options_.at_part(1);
  return std::move(out_);
}

bool Diagnosing::reports_something_new(const Diagnosis& answer) const {
  constexpr double kFar = 4;  // times the floor; a slow torque's chance is half of that
  if (prepared_.drifts || answer.surrogate || answer.only_the_loop_holds) return false;
  const bool may_close_nothing = !answer.causes.empty() && answer.gap.closed_fraction.low < 0;
  return may_close_nothing || (answer.gap.with_effect_nrmse > kFar * answer.gap.floor_nrmse && last_.excess < kReached);
}

void Diagnosing::name_changes() {
  out_.ranking = by_sets_.ranking(prepared_.defects.found);
  out_.verdict = by_sets_.verdict();
  out_.evidence = by_sets_.evidence();
  out_.surrogate =
      out_.verdict == "unknown" && prepared_.defects.found.empty() && !surrogate_refused_ && by_sets_.take_surrogate();
  out_.base_out_of_place = out_.surrogate && by_sets_.wheel_out_of_place();
  out_.causes.clear();
  named_.clear();
  slow_ = SlowTorque::kFloor;
  for (const RecordDefect& defect : prepared_.defects.found) {
    const auto known = std::ranges::find(simulation_.effects, defect.effect.type, &Effect::type);
    if (known != simulation_.effects.end() || !out_.not_credible.empty()) continue;
    named_.push_back({.effect = defect.effect, .probability = defect.probability()});
  }
  for (Cause& change : by_sets_.changes()) {
    if (change.effect.type == &effect::unmeasured_torque) slow_ = SlowTorque::kCause;
    named_.push_back(std::move(change));
  }
  if (!names_effect(out_.verdict) && !named_.empty() && !out_.surrogate) {
    out_.verdict = std::string(named_.front().effect.type->id);
  }
  out_.equivalent = by_sets_.equivalents();
  last_ = by_sets_.final_fit();
}

void Diagnosing::build_simulations() {
  out_.refit = simulation_;
  out_.refit.wheel = by_sets_.refit().at().wheel;
  rest_on_last_fit();
  out_.with_effect = simulation_;
  if (out_.verdict == "none") return;
  if (named_.empty() && out_.verdict == "unknown") return;  // the refit, once it is known to be one
  out_.with_effect.wheel = last_.at.wheel;
  if (out_.verdict == "parameters") return;
  for (const Cause& change : named_) apply(change, out_.with_effect);
  // What is no size of a given effect is fitted with the rest.
  for (const Effect& fitted : last_.at.effects) {
    const auto same = std::ranges::find(out_.with_effect.effects, fitted.type, &Effect::type);
    if (same != out_.with_effect.effects.end()) *same = fitted;
  }
  add_slow_torque();
}

void Diagnosing::rest_on_last_fit() {
  floor_ = last_.floor;
  // A model that misses something would have it in its slow torque; what a steering driver adds is bounded in the fit.
  if (slow_ == SlowTorque::kFloor && !(prepared_.lowest_hz > 0)) {
    floor_.slow_variance =
        std::min(floor_.slow_variance, std::pow(kUsualSlowShare * prepared_.spectral->applied_rms_nm, 2));
  }
  out_.base = last_.base;
  if (out_.verdict == "unknown") allow_for_given();
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
  std::vector<double> rest = prepared_.run(out_.with_effect);
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = prepared_.defects.repaired.angle_rad[i] - rest[i];
  std::vector<char> use(rest.size());
  for (std::size_t i = 0; i < use.size(); ++i) use[i] = out_.series.held_out[i] == 0 || i % 2 == 0 ? 1 : 0;
  Effect effect = slow_torque(prepared_.record, out_.with_effect.wheel, rest, use, floor_);
  Simulation beside = out_.with_effect;  // of the repaired record
  std::erase_if(beside.effects, [](const Effect& one) { return hypothesis_of(*one.type) == nullptr; });
  if (!beside.effects.empty() && !prepared_.drifts) {
    effect = slow_torque_by_runs(prepared_.defects.repaired, prepared_.stretches, beside, effect, use, floor_);
  }
  effect.at("rms_nm") = std::min(course_rms_nm(effect), effect.type->parameters.front().high);
  const auto cause = std::ranges::find(named_, effect.type, [](const Cause& one) { return one.effect.type; });
  if (cause != named_.end()) cause->effect.values = effect.values;  // its size, not a usual one
  out_.with_effect.effects.push_back(std::move(effect));
  // Its time course is known now: it is no part of the floor any more.
  floor_.slow_variance = 0;
}

}  // namespace steerid::gap
