// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "gap/diagnosis/diagnosing.hpp"
#include "gap/diagnosis/held_out_runs.hpp"
#include "gap/diagnosis/named_change.hpp"
#include "gap/diagnosis/shared_among.hpp"
#include "gap/diagnosis/shrinkage.hpp"
#include "gap/diagnosis/verdict_ids.hpp"
#include "gap/hypotheses/hypotheses.hpp"
#include "gap/model/floor_rms.hpp"
#include "gap/model/floor_runs.hpp"
#include "gap/model/restarted_run.hpp"
#include "log/resample.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// How long a run lasts on the part that reports, where it begins anew there.
double held_out_run_s(const std::vector<Block>& blocks) {
  return static_cast<double>(std::ranges::find(blocks, Block::Role::kReport, &Block::role)->count) / kResampledRateHz;
}

}  // namespace

void Diagnosing::measure() {
  out_.not_credible = options_.not_credible;
  if (!out_.not_credible.empty()) {
    by_sets_.believe_nothing();
    surrogate_refused_ = true;
  }
  for (;;) {
    name_changes();
    build_simulations();
    run_simulations();
    if (refuse_by_runs()) continue;
    size_gap();
    if (!refuse_by_sizes()) break;
  }
  const Simulation& simulated = out_.with_effect;
  out_.only_the_loop_holds = !named_.empty() && prepared_.whittle->white().at_most &&
                             !holds_itself(prepared_.record, prepared_.stretches, simulated.wheel, simulated.effects,
                                           simulated.torque_between_samples);
  if (out_.only_the_loop_holds) out_.gap.closed_fraction.value = std::numeric_limits<double>::quiet_NaN();
  describe_changes();
}

void Diagnosing::put_remainder_back() {
  GapSeries& series = out_.series;
  for (std::vector<double>* angle_rad :
       {&series.measured_rad, &series.sim_rad, &series.refit_rad, &series.with_effect_rad}) {
    for (std::size_t i = 0; i < angle_rad->size(); ++i) (*angle_rad)[i] += prepared_.remainder_rad[i];
  }
}

void Diagnosing::run_simulations() {
  GapSeries& series = out_.series;
  series.sim_rad = prepared_.run(simulation_);
  series.refit_rad = prepared_.run(out_.refit);
  if (held_out_nrmse(series.refit_rad) > held_out_nrmse(series.sim_rad)) {  // other J, B, C help nobody
    out_.refit = simulation_;
    series.refit_rad = series.sim_rad;
  }
  if (out_.verdict == "unknown" && named_.empty()) out_.with_effect = out_.refit;
  series.with_effect_rad = prepared_.run(out_.with_effect);
}

void Diagnosing::size_gap() {
  const GapSeries& series = out_.series;
  double quantum = 0;
  for (const Effect& effect : out_.with_effect.effects) {
    if (effect.type == &effect::coarse_quantization) quantum = effect.values[0];
  }
  // Friction holds most of what the noise would move a free wheel by. A rounded angle hides its noise.
  std::optional<double> floor_rad;
  if (!out_.with_effect.effects.empty() && !(quantum > 0)) {
    floor_rad = floor_by_runs_rad(out_.with_effect, prepared_.record, prepared_.stretches, series.with_effect_rad,
                                  floor_, options_.seed);
  }
  const bool fitted = out_.verdict != "none" && (out_.verdict != "unknown" || out_.surrogate);
  out_.gap = shrinkage({.record = prepared_.record,
                        .blocks = prepared_.blocks,
                        .sim_rad = series.sim_rad,
                        .refit_rad = series.refit_rad,
                        .with_effect_rad = series.with_effect_rad,
                        .gain = prepared_.drifts
                                    ? held_gain(within_run(out_.with_effect.wheel, held_out_run_s(prepared_.blocks)))
                                    : gain_with(out_.with_effect.wheel, out_.with_effect.effects),
                        .floor = floor_,
                        .floor_rad = floor_rad,
                        .quantum_rad = quantum,
                        .unsure_rad2 = fitted ? moved_by_numbers_rad2(prepared_, out_.with_effect, series, last_)
                                              : std::vector<double>(),
                        .every_second = slow_ == SlowTorque::kCause,
                        .draws = options_.bootstrap_draws,
                        .seed = options_.seed});
}

bool Diagnosing::refuse_by_runs() {
  if (!out_.surrogate) {
    const std::vector<const EffectType*> idle = together_ ? std::vector<const EffectType*>() : idle_changes();
    if (!idle.empty()) by_sets_.refuse(*idle.front());
    return !idle.empty();
  }
  if (held_out_nrmse(out_.series.with_effect_rad) < held_out_nrmse(out_.series.refit_rad)) return false;
  refuse_surrogate();
  return true;
}

bool Diagnosing::refuse_by_sizes() {
  if (!out_.surrogate) {
    if (together_ || out_.verdict != "parameters") return false;
    if (!is_nearer(out_.series.sim_rad, out_.series.with_effect_rad)) return false;
    by_sets_.refuse_wheel(out_.gap.sim_nrmse <= (1 + kFloorKnownTo) * out_.gap.floor_nrmse);
    return true;
  }
  // An interval wider than the gap does not say that the surrogate is nearer.
  const BoundedValue& closed = out_.gap.closed_fraction;
  if (!std::isfinite(closed.value) || closed.low >= -1) return false;
  refuse_surrogate();
  return true;
}

void Diagnosing::refuse_surrogate() {
  surrogate_refused_ = true;
  by_sets_.refuse_surrogate();
}

bool Diagnosing::is_nearer(const std::vector<double>& run_rad, const std::vector<double>& than_rad) const {
  // A change that moves the held-out run by less than noise hides has nothing to say for itself there and nothing
  // against it, such as a hand that leaves the wheel elsewhere only: n errors of the deviation s tell a difference of
  // 2 s/sqrt(n).
  // Where a loop answers what moves the wheel a free run strays by what it missed and says little of any change.
  if (prepared_.whittle->white().at_most) return false;
  constexpr double kDeviations = 2;
  const std::vector<char>& there = out_.series.held_out;
  const double than = held_out_nrmse(than_rad);
  if (!std::isfinite(than)) return std::isfinite(held_out_nrmse(run_rad));
  const double told_rad = kDeviations * std::sqrt(held_out_square(out_.series.measured_rad, than_rad, there) /
                                                  std::max(last_.choose_lines, 1.0));
  const double moved_rad = std::sqrt(held_out_square(than_rad, run_rad, there));
  return moved_rad > told_rad && held_out_nrmse(run_rad) < than;
}

/// Two runs that are m apart, beside an error of s, differ in its square by 4 s m/sqrt(n) at twice the deviation.
bool Diagnosing::closes_by_more_than_chance() const {
  const GapSeries& series = out_.series;
  const double refit = held_out_square(series.measured_rad, series.refit_rad, series.held_out);
  const double left = held_out_square(series.measured_rad, series.with_effect_rad, series.held_out);
  const double apart = held_out_square(series.with_effect_rad, series.refit_rad, series.held_out);
  return refit - left > 4 * std::sqrt(left * apart / std::max(last_.choose_lines, 1.0));
}

std::vector<const EffectType*> Diagnosing::idle_changes() const {
  std::vector<const EffectType*> idle;
  const Cause* least_sure = nullptr;
  bool all_known_ahead = true;
  for (const Cause& change : named_) {
    // A slow torque's course is taken from the record; and what begins and ends at instants is not known ahead.
    const Hypothesis* hypothesis = hypothesis_of(*change.effect.type);
    if (hypothesis == nullptr || hypothesis->timed()) {
      all_known_ahead = false;
      continue;
    }
    if (least_sure == nullptr || change.probability < least_sure->probability) least_sure = &change;
    Simulation rest = out_.with_effect;
    revert(change, rest);
    if (is_nearer(prepared_.run(rest), out_.series.with_effect_rad)) idle.push_back(change.effect.type);
  }
  // Each may help beside the others, and all of them with the J, B and C that they need be worse than none.
  if (idle.empty() && all_known_ahead && least_sure != nullptr &&
      is_nearer(out_.series.refit_rad, out_.series.with_effect_rad)) {
    idle.push_back(least_sure->effect.type);
  }
  // Beside a driver's steering every change fits a little of what he does: it has to show what it is worth.
  if (idle.empty() && prepared_.lowest_hz > 0 && !named_.empty() && !closes_by_more_than_chance()) {
    idle.push_back(std::ranges::min_element(named_, {}, &Cause::probability)->effect.type);
  }
  return idle;
}

void Diagnosing::describe_changes() {
  const double told_at_least = std::max({out_.gap.refit_nrmse - out_.gap.floor_nrmse,
                                         kFloorKnownTo * out_.gap.floor_nrmse, std::numeric_limits<double>::min()});
  const double left = std::max(out_.gap.with_effect_nrmse - out_.gap.floor_nrmse, 0.0);
  out_.unexplained.complete = left <= kFloorKnownTo * out_.gap.floor_nrmse;
  if (!out_.unexplained.complete) out_.unexplained.share_of_gap = std::min(left / told_at_least, 1.0);
  out_.inclusion = by_sets_.inclusion().changes;
  const std::vector<double> closes = closed_by_each();
  for (std::size_t i = 0; i < named_.size(); ++i) {
    Cause& cause = out_.causes.emplace_back(named_[i]);
    cause.closes = closes[i] / told_at_least;
    const auto found = std::ranges::find(last_.at.effects, cause.effect.type, &Effect::type);
    if (cause.change != ChangeKind::kRemove && found != last_.at.effects.end()) {
      cause.parameters = last_.parameters[static_cast<std::size_t>(found - last_.at.effects.begin())];
    }
  }
  std::ranges::stable_sort(out_.causes, std::ranges::greater(), &Cause::closes);
  if (!out_.causes.empty() && names_effect(out_.verdict)) {
    out_.verdict = std::string(out_.causes.front().effect.type->id);
  }
}

std::vector<double> Diagnosing::closed_by_each() const {
  const std::uint64_t all = (std::uint64_t{1} << named_.size()) - 1;
  return shared_among(named_.size(), [&](std::uint64_t made) {
    if (made == all) return out_.gap.refit_nrmse - out_.gap.with_effect_nrmse;
    if (made == 0) return 0.0;
    Simulation partial = out_.with_effect;
    for (std::size_t i = 0; i < named_.size(); ++i) {
      if ((made >> i & 1) == 0) revert(named_[i], partial);
    }
    const double closed = out_.gap.refit_nrmse - held_out_nrmse(prepared_.run(partial));
    return closed > 0 ? closed : 0.0;  // nobody makes changes that do not help, or whose run does not stay finite
  });
}

double Diagnosing::held_out_nrmse(const std::vector<double>& angle) const {
  return std::sqrt(held_out_square(out_.series.measured_rad, angle, out_.series.held_out)) /
         held_out_sd(prepared_.record, prepared_.blocks);
}

}  // namespace steerid::gap
