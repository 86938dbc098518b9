// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The stage by free runs, from where the stage before it may end (gap/drawn_drive.hpp makes the drives).
#include "gap/comparison/free_run_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "gap/compared_drive.hpp"
#include "gap/model/simulated_model.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// As if it left that much.
Candidate leaving(double excess, Candidate one) {
  Misfit& fitted = one.fit.misfit[static_cast<std::size_t>(Block::Role::kFit)];
  fitted.cost = fitted.chi = excess * fitted.lines;
  one.fit.penalty = 0;
  return one;
}

/// On the measured motion a spring may come out a little too soft to hold the wheel: no free run begins there, and none
/// says which way is better.
TEST(FreeRunStage, LeavesASpringThatLetsTheWheelGo) {
  constexpr double kCubic = -200;
  test::DrawnDrive what;
  what.torque = [](double, double x, double) { return -kCubic * x * x * x; };
  const test::ComparedDrive compared(what, test::seed(84));
  const auto spring = [](double cubic) {
    Effect effect(effect::cubic_stiffness);
    effect.values[0] = cubic;
    return effect;
  };
  const auto lets_go = [&](const Effect& one) {
    SimulatedModel runs(compared.spectral, compared_parts({one}).parts);
    return runs.run(joined(what.wheel, {one})).empty();
  };
  ASSERT_FALSE(lets_go(spring(kCubic)));
  ASSERT_TRUE(lets_go(spring(1.4 * kCubic)));
  const ComparedParts there = compared_parts({});
  std::vector<Candidate> candidates = {compared.candidate(there, "cubic_stiffness", spring(1.4 * kCubic))};
  fit_by_free_runs(compared.setting, there, candidates);
  EXPECT_EQ(candidates[0].motion, Motion::kFreeRuns);
  EXPECT_NEAR(candidates[0].fit.x[3], kCubic, 0.02 * -kCubic);
  EXPECT_NEAR(candidates[0].fit.excess(kSeen), 1, 0.15);  // some 500 lines
}

/// How fast a drag is depends on how fast the wheel is: of 2 b2 v/J, 45 in place of 0.035 kg m2, a movement of 0.1
/// rad/s makes 257 /s, which a record shows, and one of 0.5 rad/s 1286 /s, which is over within a tenth of a sample.
TEST(FreeRunStage, RunsADragThatIsFastInBriskMovementsOnly) {
  test::DrawnDrive what;
  what.wheel = {0.035, 2.0, 40.0};
  const auto runs = [&](double probe_rms_nm) {
    what.probe_rms_nm = probe_rms_nm;
    const test::ComparedDrive compared(what, test::seed(92));
    Effect drag(effect::quadratic_damping);
    drag.values[0] = 45;
    SimulatedModel model(compared.spectral, compared_parts({drag}).parts);
    return !model.run(joined(what.wheel, {drag})).empty();
  };
  EXPECT_TRUE(runs(0.3));
  EXPECT_FALSE(runs(8));
}

/// Beside a delay, which is linear, the measured motion shows what a second effect gains: what gains a hundredth there
/// is not run, what gains a fifth is.
TEST(FreeRunStage, RunsBesideALinearEffectWhatGainsOnTheMeasuredMotion) {
  const test::ComparedDrive compared({}, test::seed(85));
  const ComparedParts there = compared_parts({Effect(effect::delay)});
  std::vector<Candidate> candidates = {
      leaving(2.1, compared.candidate(there, "none")), leaving(2, compared.candidate(there, "parameters")),
      leaving(1.98, compared.candidate(there, "quadratic_damping", Effect(effect::quadratic_damping))),
      leaving(1.6, compared.candidate(there, "cubic_stiffness", Effect(effect::cubic_stiffness)))};
  fit_by_free_runs(compared.setting, there, candidates);
  EXPECT_EQ(candidates[2].motion, Motion::kMeasured);
  EXPECT_FALSE(candidates[2].compared);
  EXPECT_TRUE(candidates[3].compared);
}

/// On the measured motion one kind of friction can be far better than another that free runs fit as well: where one is
/// run, all are.
TEST(FreeRunStage, RunsEveryKindOfAFrictionThatIsRun) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.3;
  const test::ComparedDrive compared(what, test::seed(86));
  const ComparedParts there = compared_parts({});
  const auto candidate = [&](const EffectType& type, double excess) {
    return leaving(excess, compared.candidate(there, type.id, Effect(type)));
  };
  // The fourth of the best is the last that is run; here it is a friction.
  std::vector<Candidate> candidates = {candidate(effect::cubic_stiffness, 1.5), candidate(effect::torque_ripple, 1.7),
                                       candidate(effect::quadratic_damping, 1.9),
                                       candidate(effect::stribeck_friction, 2.5),
                                       candidate(effect::coulomb_friction, 40)};
  fit_by_free_runs(compared.setting, there, candidates);
  EXPECT_TRUE(candidates[3].compared);
  EXPECT_TRUE(candidates[4].compared);
}

}  // namespace
}  // namespace steerid
