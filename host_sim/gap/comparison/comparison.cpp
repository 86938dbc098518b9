// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/comparison/comparison.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "gap/comparison/free_run_stage.hpp"
#include "gap/comparison/wheel_shift.hpp"
#include "gap/model/simulated_model.hpp"
#include "parallel/work_in_parallel.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

bool among(const std::vector<std::string>& ids, std::string_view id) { return std::ranges::find(ids, id) != ids.end(); }

/// Of one family one record shows one at most: what the second adds is a bend of the first.
bool of_one_family(const EffectType& a, const EffectType& b) {
  const Hypothesis* one = hypothesis_of(a);
  const Hypothesis* other = hypothesis_of(b);
  return one != nullptr && other != nullptr && one->family() != Hypothesis::Family::kNone &&
         one->family() == other->family();
}

/// The wheel with what is already there, refitted.
Whittle::Fit base_fit(const ComparisonSetting& setting, const ComparedParts& there, SpectralModel& base,
                      const std::vector<Fitted>& fitted) {
  if (setting.base) return *setting.base;
  Whittle::Fit best;
  double least = std::numeric_limits<double>::infinity();
  for (const WheelArm& start : {setting.sim, setting.refit}) {
    Whittle::Fit fit = setting.whittle.fit(base, joined(start, there.present), fitted, kFitted, setting.slow, 200);
    if (fit.cost(kFitted) < least) {
      least = fit.cost(kFitted);
      best = std::move(fit);
    }
  }
  return best;
}

/// By how much a free run of what is there leaves more than the model on the measured motion, where that is no more
/// than an approximation.
Spectrum offset_of(const ComparisonSetting& setting, const ComparedParts& there, const Eigen::VectorXd& x) {
  if (!setting.base_by_runs) return {};
  Spectrum by_run;
  Spectrum on_motion;
  Response response;
  SimulatedModel(setting.record, there.parts, there.fixed, setting.course).evaluate(x, by_run, response);
  SpectralModel(setting.record, there.parts).evaluate(x, on_motion, response);
  return by_run - on_motion;
}

}  // namespace

bool switches(std::string_view id) { return id == "backlash" || id == "hands_off"; }

bool goes_with(const EffectType& type, const std::vector<Effect>& present) {
  if (std::ranges::any_of(present, [&](const Effect& one) { return of_one_family(*one.type, type); })) return false;
  try {
    std::vector<Effect> together = present;
    together.emplace_back(type);
    check_compatible(together);
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

std::optional<Effect> fitted_effect(const Candidate& candidate) {
  if (candidate.type == nullptr || candidate.type == &effect::unmeasured_torque) return std::nullopt;
  Effect effect(*candidate.type);
  std::copy(candidate.fit.x.end() - std::ssize(effect.values), candidate.fit.x.end(), effect.values.begin());
  return effect;
}

SlowTorque ComparisonSetting::slow_beside(const EffectType* type) const {
  return type == &effect::unmeasured_torque ? SlowTorque::kCause : slow;
}

const Candidate& Comparison::at(std::string_view id) const {
  for (const Candidate& one : candidates) {
    if (one.id == id) return one;
  }
  throw std::logic_error("no such candidate");
}

Comparison compare(const ComparisonSetting& setting) {
  const ComparedParts there = compared_parts(setting.present);
  Comparison out;
  out.fixed = there.fixed;
  out.by_runs = !there.all_exact();
  out.slow = setting.slow;
  out.switches = std::ranges::any_of(there.parts, [](const Hypothesis* part) { return switches(part->type().id); });
  const auto [least, most] = std::ranges::minmax(setting.record.motion.angle_rad);
  out.swing_rad = most - least;
  // The wheel as it is, and refitted.
  const auto fitted = fitted_parameters(setting.sim, setting.refit, there.parts);
  SpectralModel base(setting.record, there.parts);
  const Eigen::VectorXd given = joined(setting.sim, there.present);
  out.candidates = {{"none", nullptr, setting.whittle.judge(base, given, fitted, kFitted, setting.slow)},
                    {"parameters", nullptr, base_fit(setting, there, base, fitted)}};
  const Spectrum offset = offset_of(setting, there, out.candidates[1].fit.x);
  const auto origins_on = [&](const Whittle::Roles& roles) {
    std::vector<SearchOrigin> origins;
    for (const std::size_t i : {1U, 0U}) {
      // Where an effect is already fitted its wheel is the nearer one, unless it made up for what is missing.
      if (i == 0 && setting.base && shift_from(setting.sim, wheel_of(setting.base->x)) < kFarthestShift) continue;
      const Whittle::Fit& fit = out.candidates[i].fit;
      origins.push_back({LinearScan(setting.record, setting.whittle, there.parts, fit, roles, offset), fit.x,
                         with_torques_of(there.parts, setting.record, fit.x)});
    }
    return origins;
  };
  const std::vector<SearchOrigin> origins = origins_on(roles_of("", there));
  const std::vector<SearchOrigin> origins_in_time = origins_on(kSeen);
  if (!among(setting.without, "unmeasured_torque") && setting.slow == SlowTorque::kFloor) {
    Candidate slow{"unmeasured_torque", &effect::unmeasured_torque, {}};
    // Beside what free runs know better it begins where they ended.
    const int steps = setting.base_by_runs ? 0 : 60;
    slow.fit =
        setting.whittle.fit(base, out.at("parameters").fit.x, fitted, roles_of("", there), SlowTorque::kCause, steps);
    out.candidates.push_back(slow);
  }
  const std::size_t first = out.candidates.size();
  for (const auto& hypothesis : hypotheses()) {
    const EffectType& type = hypothesis->type();
    const bool present = std::ranges::any_of(there.present, [&](const Effect& one) { return one.type == &type; });
    if (present || among(setting.without, type.id) || !goes_with(type, there.present)) continue;
    out.candidates.push_back({std::string(type.id), &type, {}});
  }
  // Those with many numbers take longest and begin first, or one core would wait for the last of them.
  std::vector<std::size_t> order(out.candidates.size() - first);
  std::iota(order.begin(), order.end(), first);
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::size_t i) { return out.candidates[i].type->parameters.size(); });
  work_in_parallel(order.size(), setting.threads, [&](std::size_t i) {
    Candidate& one = out.candidates[order[i]];
    const Whittle::Roles& roles = roles_of(one.id, there);
    one.fit =
        search(*there.of(one.type), {setting.record, setting.whittle, roles.size() > 1 ? origins_in_time : origins,
                                     there.parts, setting.sim, setting.refit, roles, setting.slow, offset});
  });
  fit_by_free_runs(setting, there, out.candidates);
  return out;
}

}  // namespace steerid
