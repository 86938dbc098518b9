// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/comparison/preferred_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "gap/comparison/wheel_shift.hpp"
#include "gap/model/carried_record.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/model/simulated_model.hpp"

namespace steerid {
namespace {

constexpr double kReached = 1.15;  // an excess that nothing needs to better

/// Whether it is so of the candidate or of something that is there.
bool any_of(const ComparedParts& there, const Candidate& one, bool (Hypothesis::*is)() const) {
  const Hypothesis* own = there.of(one.type);
  return (own != nullptr && (own->*is)()) ||
         std::ranges::any_of(there.parts, [&](const Hypothesis* part) { return (part->*is)(); });
}

constexpr double kMuch = 30;  // nats, over the excess

double gained_nats(const Whittle::Fit& fit, const Whittle::Fit& than, const Whittle::Roles& roles) {
  return (than.cost(roles) - fit.cost(roles)) / than.excess(roles);
}

/// Whether a fit has the wheel where the other one has it.
bool stays_near(const WheelArm& sim, const Whittle::Fit& fit, const Whittle::Fit& than) {
  constexpr double kStays = 2;     // of shift
  constexpr double kFarthest = 4;  // of shift: a simulation's, and something
  const auto shift = [&](const Whittle::Fit& of) { return shift_from(sim, wheel_of(of.x)); };
  return shift(fit) < std::min(kFarthest, shift(than) + kStays);
}

/// Whether a fit of another kind is to be believed in place of one.
bool much_better(const WheelArm& sim, const Whittle::Fit& fit, const Whittle::Fit& than, const Whittle::Roles& roles) {
  return gained_nats(fit, than, roles) > kMuch && stays_near(sim, fit, than);
}

/// Fitted on the motion that the run of the fit carries, and again on what the one so found carries.
Whittle::Fit on_carried_motion(const ComparisonSetting& setting, const ComparedParts& there, const Candidate& one) {
  constexpr int kRounds = 2;
  const SpectralModel::Parts parts = there.with(one.type);
  SimulatedModel run(setting.record, parts, there.fixed, one.course);
  Whittle::Fit fit = one.fit;
  for (int round = 0; round < kRounds; ++round) {
    const SpectralRecord carried = carried_record(setting.record, run, fit.x);
    SpectralModel on_motion(carried, parts);
    fit = setting.whittle.fit(on_motion, fit.x, fitted_parameters(setting.sim, setting.refit, parts),
                              roles_of(one.id, there), setting.slow_beside(one.type), kMotionBudget);
  }
  return fit;
}

}  // namespace

bool sticks(const ComparedParts& there, const Candidate& one) { return any_of(there, one, &Hypothesis::sticks); }

bool leaves(const ComparedParts& there, const Candidate& one) { return any_of(there, one, &Hypothesis::lets_go); }

void prefer_motion(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one) {
  one.compared = true;
  const Whittle::Roles& roles = roles_of(one.id, there);
  const bool by_runs = one.motion == Motion::kFreeRuns;
  if (sticks(there, one) || (by_runs && one.fit.excess(roles) < kReached)) return;
  Whittle::Fit fit = on_carried_motion(setting, there, one);
  if (by_runs && !much_better(setting.sim, fit, one.fit, roles)) return;
  one.fit = std::move(fit);
  one.motion = Motion::kCarried;
}

void prefer_slow_course(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one) {
  constexpr double kHopeless = 60;  // an excess that no slow torque makes
  // Nats of one step towards a course, or a run has no use for one (docs/adr/0013).
  constexpr double kFelt = 4;
  constexpr double kOvershot = 10;          // more lost than that: the step was too long
  constexpr double kPromising = kMuch / 2;  // of a first course; later ones gain little more
  const Whittle::Roles& roles = roles_of(one.id, there);
  const double excess = one.fit.excess(roles);
  if (setting.record.anew_each_block || !any_of(there, one, &Hypothesis::freed_by_slow_torque) || excess < kReached ||
      excess > kHopeless)
    return;
  const SlowTorque slow = setting.slow_beside(one.type);
  const SpectralModel::Parts parts = there.with(one.type);
  const auto fitted = fitted_parameters(setting.sim, setting.refit, parts);
  RunSlopes slopes(setting.record, parts);
  const SlowPrior prior = slow_prior(setting.record, setting.whittle, slow);
  Whittle::Fit fit = one.fit;
  std::shared_ptr<const SlowCourse> course = one.course;
  const auto go_on = [&](int steps) {
    course = std::make_shared<const SlowCourse>(
        slow_course(setting.record, parts, there.fixed, fit.x, prior, steps, course.get()));
    return SimulatedModel(setting.record, parts, there.fixed, course);
  };
  if (!one.course) {
    SimulatedModel run = go_on(1);
    const double gained = gained_nats(setting.whittle.judge(run, fit.x, fitted, roles, slow), fit, roles);
    if (gained > -kOvershot && gained < kFelt) return;
  }
  constexpr int kRest = 3;  // of the first course, behind that step
  constexpr int kMore = 2;  // of one that is known
  const int rounds = one.course ? 1 : 3;
  for (int round = 0; round < rounds; ++round) {
    SimulatedModel run = go_on(round == 0 && !one.course ? kRest : kMore);
    fit = setting.whittle.fit(run, fit.x, fitted, roles, slow, kRunBudget, &slopes);
    if (gained_nats(fit, one.fit, roles) < kPromising || !stays_near(setting.sim, fit, one.fit)) return;
  }
  if (gained_nats(fit, one.fit, roles) < kMuch) return;
  one.fit = std::move(fit);
  one.course = std::move(course);
  one.motion = Motion::kFreeRuns;
}

}  // namespace steerid
