// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/attribution/attribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "gap/attribution/verdict_ids.hpp"
#include "gap/comparison/dry_friction_forms.hpp"
#include "gap/comparison/wheel_shift.hpp"
#include "gap/likelihood/noise_shape.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid {
namespace {

/// The slow torque over the applied one that a fit's blocks show.
double slow_share_shown(const Candidate& candidate, const Whittle& whittle) {
  return std::sqrt(candidate.fit.floor.slow_variance) / whittle.applied_rms_nm();
}

/// The same, or what the run misses where that is more: what changes within half a minute hardly shows in a block.
double slow_share(const Candidate& candidate, const Whittle& whittle) {
  return std::max(slow_share_shown(candidate, whittle), candidate.slow_share_of_run.value_or(0));
}

/// By how much a richer kind of dry friction differs from Coulomb's, over the applied torque; nothing for what is none.
std::optional<double> beyond_coulomb(const Candidate& candidate, const Whittle& whittle) {
  if (candidate.id != "asymmetric_friction" && candidate.id != "stribeck_friction") return std::nullopt;
  const Effect friction = *fitted_effect(candidate);
  const double more_nm = candidate.id == "asymmetric_friction"
                             ? std::abs(friction.at("friction_forward_nm") - friction.at("friction_backward_nm")) / 2
                             : friction.at("friction_nm") * (friction.at("breakaway_ratio") - 1);
  return more_nm / whittle.applied_rms_nm();
}

/// Whether a number of the effect stands at the upper end of its range. How far friction bends before it slips says
/// nothing of its kind.
bool at_bound(const Candidate& candidate) {
  const std::optional<Effect> effect = fitted_effect(candidate);
  for (std::size_t i = 0; effect && i < effect->values.size(); ++i) {
    const Parameter& parameter = effect->type->parameters[i];
    if (parameter.name != "bristle_rad" && effect->values[i] > 0.999 * parameter.high) return true;
  }
  return false;
}

/// What a right effect may leave, relative to one that switches: excess over the floor, and share of the gap. Kinds of
/// dry friction stand in for each other and leave least when right.
struct Leniency {
  double excess;
  double unclosed;
};

Leniency leniency_for(const Evidence& one) {
  if (one.switches) return {1.0, 1.0};
  return dry_friction(one.id) ? Leniency{0.3, 0.15} : Leniency{0.5, 0.3};
}

/// How far the best fit is from explaining the record, as a logit per unit of sharpness: how far it stays above the
/// floor and what share of the gap it leaves open, whichever speaks less.
double lack_of_fit(const Evidence& best, double refit_excess, const AttributionCoefficients& by) {
  const double excess = std::max(best.excess - 1, 0.02);
  const double gap = std::max(refit_excess - 1, 0.05);
  const double unclosed = std::clamp(excess / gap, 1e-4, 1.0);
  // What an effect leaves is forgiven less where J, B and C had to go far to make room for it: that is how a stand-in
  // fits. A simulation that is 8 % off in all three has a shift of 3.
  constexpr double kUsualShift = 3.5;
  constexpr double kStrictness = 0.12;
  const double by_shift = std::exp(-kStrictness * std::max(0.0, best.shift - kUsualShift));
  const Leniency leniency = leniency_for(best);
  return std::min(std::log(excess / (by.unknown_excess * leniency.excess * by_shift)),
                  std::log(unclosed / (by.unknown_unclosed * leniency.unclosed * by_shift)));
}

/// What speaks for nothing.
constexpr double kSilent = -std::numeric_limits<double>::infinity();

/// What a figure says: nothing at `half`, which leaves a fit half unknown. Silent where there is none.
double speaks(double figure, double half, double plainly) {
  return figure > 0 ? plainly * std::log(figure / half) : kSilent;
}

/// How much larger the floor's slow torque has to be than any driver's for the fit, likewise: what a model misses at
/// low frequency looks like it. Play and absence miss some there even when they are right; and where free runs with a
/// usual slow torque leave next to nothing of the gap, a larger one is the price of a stick that ends a little late.
double made_up_by_slow_torque(const Evidence& best) {
  constexpr double kHalfUnknown = 0.033;  // share of the applied torque; drivers have 0.02, and 0.05 is a cause
  constexpr double kPlainly = 2.5;
  constexpr double kNextToNothing = 0.02;  // of the gap's power
  if (best.switches || best.run_error.value_or(1) < kNextToNothing) return kSilent;
  return speaks(best.slow_share, kHalfUnknown, kPlainly);
}

/// How plainly a shape without a name explains what the best fit leaves, likewise: by what it gains beyond the price of
/// its coefficients, by its share of all that is left above the floor (whose own spread is the root of its lines), and
/// by its share of the whole gap: no simulation is exact to thousandths, and a large gap shows them.
double claimed_by_rivals(const Evidence& best, double refit_excess, const AttributionCoefficients& by) {
  constexpr double kOfGap = 0.004;
  const double gap_nats = std::max(refit_excess - 1, 0.05) * best.lines;
  double loudest = kSilent;
  for (const Rival& rival : best.rivals) {
    // What a simulation states more simply than a machine does leaves something, of which one shape is like a part.
    const Claim& half = rival.free == 1 && !best.switches ? by.shape : by.family;
    // A quarter of the record beside the half that it was fitted on: half the gain, if it is real.
    const double gained = 1.5 * std::min(rival.fit_nats, 2 * rival.choose_nats);
    const double price = rival.free * std::log(std::max(best.lines, 2.0)) / 2;
    const double nats = (gained - price) / (1 + rival.left / best.lines);
    if (nats <= 0) continue;
    const double share = gained / (rival.left + std::sqrt(best.lines));
    loudest = std::max(loudest, std::min({std::log(nats / half.nats), std::log(share / half.share),
                                          std::log(gained / (kOfGap * gap_nats))}));
  }
  return loudest;
}

/// How plainly the free run contradicts a fit, likewise: lines that the floor fills count for little in a likelihood,
/// and an effect may fit all others and yet take the wheel further from the record than the best linear one came.
double contradicted_by_run(const Evidence& best) {
  constexpr double kHalfUnknown = 0.4;  // right effects leave 0.3 at most
  constexpr double kPlainly = 2.5;
  return speaks(best.run_error.value_or(0), kHalfUnknown, kPlainly);
}

/// How plainly J, B and C have to go further than a simulation is off, likewise: a stand-in may fit to the floor with
/// them out of place, as friction that falls with speed does for one that does not, with the damping that makes up for
/// it.
double out_of_place(const Evidence& best) {
  constexpr double kPlainly = 4;
  return speaks(best.shift_at_least, kOutOfPlace, kPlainly);
}

/// How plainly what passes for a slow torque is a single tone, likewise.
double single_tone(const Evidence& best) {
  constexpr double kHalfUnknown = 0.76;  // of 33 slow torques none had more than 0.70; sinusoids have 0.80 and more
  constexpr double kPlainly = 12;
  return speaks(best.slow_line_share, kHalfUnknown, kPlainly);
}

/// How plainly what is taken for the angle's noise is none, likewise: to have reached a floor that is no noise explains
/// nothing. An effect has more to say for itself than that.
double noise_that_is_none(const Evidence& best, double departure) {
  constexpr double kPlainly = 2;
  return names_effect(best.id) ? kSilent : speaks(departure, kNoNoise, kPlainly);
}

/// Stribeck's friction holds Coulomb's. Where neither reaches the floor, because a machine's friction bends before it
/// slips, a bend of the curve fits some of that: it counts as Stribeck's when it explains a tenth of what Coulomb's
/// leaves, and not with the steepest curve there is.
bool stribeck_without_proof(const Evidence& stribeck, const Evidence& coulomb) {
  constexpr double kBent = 1.15;
  constexpr double kProof = 0.1;
  const bool explains = stribeck.excess - 1 < (1 - kProof) * (coulomb.excess - 1);
  return coulomb.eligible && coulomb.excess > kBent && (stribeck.at_bound || !explains);
}

/// Takes back what is claimed without proof.
void ask_for_proof(const std::vector<Evidence>& all, std::vector<double>& score) {
  const auto coulomb = std::ranges::find(all, "coulomb_friction", &Evidence::id);
  const auto stribeck = std::ranges::find(all, "stribeck_friction", &Evidence::id);
  if (coulomb == all.end() || stribeck == all.end() || !stribeck_without_proof(*stribeck, *coulomb)) return;
  constexpr double kBehind = 2;  // nats
  double& claimed = score[static_cast<std::size_t>(stribeck - all.begin())];
  claimed = std::min(claimed, score[static_cast<std::size_t>(coulomb - all.begin())] - kBehind);
}

/// A difference of dry friction that is small beside the floor's slow torque is one after all where Coulomb's friction
/// without it fits far worse: the mean of a slow torque is worth a few nats.
void let_plain_differences_speak(std::vector<Evidence>& all, double impossible) {
  constexpr double kPlain = 20;          // nats
  constexpr double kLeastShare = 0.001;  // of the applied torque: a simulation's own errors are as large
  const auto nats = [](const Evidence& one) { return one.fit_nats + one.choose_nats; };
  const auto coulomb = std::ranges::find(all, "coulomb_friction", &Evidence::id);
  if (coulomb == all.end()) return;
  for (Evidence& one : all) {
    const bool plain = nats(one) < nats(*coulomb) - kPlain;
    if (plain && one.beyond_coulomb > kLeastShare && one.excess > impossible) one.eligible = true;
  }
}

/// What the simulation has, for comparison with the candidate's J, B and C. Of a stiffness that swings it may have the
/// mean, the least or the most.
WheelArm given_beside(const Candidate& one, const WheelArm& sim) {
  WheelArm given = sim;
  const std::optional<Effect> effect = fitted_effect(one);
  if (one.id != "time_varying_stiffness" || effect->at("shape") < 2) return given;
  const double swing = std::min(std::abs(effect->at("stiffness_ratio") - 1), 0.9);
  const double off = sim.stiffness_nm_per_rad / wheel_of(one.fit.x).stiffness_nm_per_rad;
  given.stiffness_nm_per_rad /= std::clamp(off, 1 - swing, 1 + swing);
  return given;
}

}  // namespace

bool beyond_the_floor(const Candidate& candidate, const Whittle& whittle, double swing_rad) {
  constexpr double kSlow_hz = 1.1;
  constexpr double kShare = 0.035;      // between the 2 % that everybody has and the 5 % that are a cause
  constexpr double kToneShare = 0.025;  // of colours that everybody has 2 % of, none is a single tone
  if (candidate.id == "periodic_disturbance") {
    const Eigen::Index last = candidate.fit.x.size() - 3;
    const double rms = candidate.fit.x[last] / std::numbers::sqrt2;
    return candidate.fit.x[last + 1] > kSlow_hz || rms > kToneShare * whittle.applied_rms_nm();
  }
  if (candidate.id == "unmeasured_torque") return slow_share(candidate, whittle) > kShare;
  if (candidate.id == "torque_ripple") {
    // Nor can one be seen that is as fine as the steps of a coarse angle: rounding is just such a saw-tooth.
    const double cycle_rad = 2 * std::numbers::pi / fitted_effect(candidate)->at("cycles_per_turn");
    return swing_rad > cycle_rad && cycle_rad > 2 * whittle.spectra().step_rad();
  }
  // Who lets go and reaches again takes a quarter of a second and more; what is shorter stands in for samples that are
  // off.
  constexpr double kShortest_s = 0.1;
  if (candidate.id == "hands_off" && fitted_effect(candidate)->at("away_s") < kShortest_s) return false;
  // What a loop moves while the hand is away says little of the inertia that is left.
  const bool hand_leaves = candidate.id == "hands_off" && !whittle.white().at_most;
  if (candidate.id == "compliance" || hand_leaves) return leaves_wheel_inertia(*fitted_effect(candidate));
  if (candidate.id == "presliding_hysteresis") return fitted_effect(candidate)->at("presliding_rad") < swing_rad;
  constexpr double kMeanShare = 0.01;
  return beyond_coulomb(candidate, whittle).value_or(1) > kMeanShare;
}

bool leaves_wheel_inertia(const Effect& effect) {
  const double share = effect.at("wheel_inertia_share");
  const auto range = std::ranges::find(effect.type->parameters, "wheel_inertia_share", &Parameter::name);
  return share > 1.01 * range->low;
}

void take_what_is_left(Evidence& evidence, const Candidate& noted) {
  evidence.rivals = noted.rivals;
  evidence.run_error = noted.run_error;
  evidence.slow_line_share = noted.slow_line_share;
}

AttributionInput attribution_input(const Comparison& comparison, const Whittle& whittle, const WheelArm& sim) {
  AttributionInput input;
  const double impossible = impossible_excess(whittle.white());
  for (const Candidate& one : comparison.candidates) {
    Evidence evidence;
    evidence.id = one.id;
    const Misfit& fitted = one.fit.misfit[static_cast<std::size_t>(Block::Role::kFit)];
    const Misfit& chosen = one.fit.misfit[static_cast<std::size_t>(Block::Role::kChoose)];
    const bool slow_is_cause = one.id == "unmeasured_torque" || comparison.slow == SlowTorque::kCause;
    const SlowTorque slow = slow_is_cause ? SlowTorque::kCause : SlowTorque::kFloor;
    const double shown = slow_share_shown(one, whittle);
    evidence.fit_nats =
        fitted.cost + one.fit.penalty + slow_penalty(slow_share(one, whittle), slow) - slow_penalty(shown, slow);
    evidence.choose_nats = chosen.cost;
    double free = one.id == "none" ? 0 : static_cast<double>(one.fit.x.size());
    if (one.id == "unmeasured_torque") free += 1;
    evidence.complexity = free * std::log(std::max(2 * fitted.lines, 2.0)) / 2;
    if (names_effect(one.id)) {
      const WheelArm given = given_beside(one, sim);
      evidence.shift = shift_from(given, wheel_of(one.fit.x));
      evidence.shift_at_least = shift_at_least(given, one.fit);
    }
    evidence.excess = one.fit.excess(kSeen);
    evidence.at_bound = at_bound(one);
    evidence.beyond_coulomb = beyond_coulomb(one, whittle).value_or(0);
    // The run of a wheel with an effect may stray for reasons of its own.
    evidence.slow_share = slow_is_cause ? 0 : one.type == nullptr ? slow_share(one, whittle) : shown;
    evidence.slow_missed = slow_is_cause ? 0 : one.slow_share_of_run.value_or(0);
    evidence.lines = fitted.lines + chosen.lines;
    evidence.simulated = one.compared;
    // Without a spring all that is missed adds up.
    evidence.switches = comparison.switches || switches(one.id) || !(sim.stiffness_nm_per_rad > 0);
    take_what_is_left(evidence, one);
    evidence.eligible = beyond_the_floor(one, whittle, comparison.swing_rad) && evidence.excess > impossible;
    if (one.id == "parameters") input.refit_excess = evidence.excess;
    input.all.push_back(evidence);
  }
  let_plain_differences_speak(input.all, impossible);
  return input;
}

std::vector<double> attribute(const AttributionInput& input, const AttributionCoefficients& by) {
  double dispersion = std::numeric_limits<double>::infinity();
  for (const Evidence& one : input.all) {
    if (one.eligible) dispersion = std::min(dispersion, one.excess);
  }
  dispersion = std::pow(std::max(dispersion, 1.0), by.dispersion_power);
  std::vector<double> score;
  for (const Evidence& one : input.all) {
    const double nats =
        (by.fit * one.fit_nats + by.choose * one.choose_nats + by.complexity * one.complexity) / dispersion +
        by.shift * one.shift + by.unknown_sharpness * std::max(0.0, out_of_place(one));
    score.push_back(one.eligible ? -nats + (one.id == "none" ? by.none : 0) : -std::numeric_limits<double>::infinity());
  }
  ask_for_proof(input.all, score);
  const double top = *std::ranges::max_element(score);
  const std::size_t best = static_cast<std::size_t>(std::ranges::max_element(score) - score.begin());
  double sum = 0;
  for (double& value : score) sum += value = std::exp(value - top);
  const Evidence& leading = input.all[best];
  const double logit =
      by.unknown_sharpness *
      std::max({lack_of_fit(leading, input.refit_excess, by), claimed_by_rivals(leading, input.refit_excess, by),
                contradicted_by_run(leading), made_up_by_slow_torque(leading), out_of_place(leading),
                single_tone(leading), noise_that_is_none(leading, input.noise_departure)});
  const double unknown = 1 / (1 + std::exp(-std::clamp(logit, -30.0, 30.0)) / by.unknown_odds);
  for (double& value : score) value *= (1 - unknown) / sum;
  score.push_back(unknown);
  return score;
}

std::size_t likeliest_of(const std::vector<double>& probability) {
  return static_cast<std::size_t>(std::max_element(probability.begin(), probability.end() - 1) - probability.begin());
}

}  // namespace steerid
