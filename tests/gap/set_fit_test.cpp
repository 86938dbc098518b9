// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Fits of sets of changes from where a search may begin them (gap/drawn_drive.hpp makes the drives).
#include "gap/sets/set_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gap/compared_drive.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/sets/discrepancy.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

Effect spring(double cubic_nm_per_rad3) {
  Effect effect(effect::cubic_stiffness);
  effect.values[0] = cubic_nm_per_rad3;
  return effect;
}

/// On the measured motion a spring may come out a little too soft to hold the wheel: no free run begins there, and none
/// says which way is better.
TEST(SetFit, LeavesASpringThatLetsTheWheelGo) {
  constexpr double kCubic = -200;
  test::DrawnDrive what;
  what.torque = [](double, double x, double) { return -kCubic * x * x * x; };
  const test::ComparedDrive compared(what, test::seed(84));
  const auto lets_go = [&](const Effect& one) {
    SimulatedModel runs(compared.spectral, hypotheses_of({one}));
    return runs.run({what.wheel, {one}}).empty();
  };
  ASSERT_FALSE(lets_go(spring(kCubic)));
  ASSERT_TRUE(lets_go(spring(1.4 * kCubic)));
  const FittedSet found =
      SetFitter(compared.setting)
          .fit(test::ComparedDrive::with(effect::cubic_stiffness), {what.wheel, {spring(1.4 * kCubic)}});
  EXPECT_NEAR(found.at().effects.front().values.front(), kCubic, 0.02 * -kCubic);
  EXPECT_NEAR(found.excess(), 1, 0.15);  // some 500 lines
}

/// How fast a drag is depends on how fast the wheel is: of 2 b2 v/J, 45 in place of 0.035 kg m2, a movement of 0.1
/// rad/s makes 257 /s, which a record shows, and one of 0.5 rad/s 1286 /s, which is over within a tenth of a sample.
TEST(SetFit, RunsADragThatIsFastInBriskMovementsOnly) {
  test::DrawnDrive what;
  what.wheel = {0.035, 2.0, 40.0};
  const auto runs = [&](double probe_rms_nm) {
    what.probe_rms_nm = probe_rms_nm;
    const test::ComparedDrive compared(what, test::seed(92));
    Effect drag(effect::quadratic_damping);
    drag.values[0] = 45;
    SimulatedModel model(compared.spectral, hypotheses_of({drag}));
    return !model.run({what.wheel, {drag}}).empty();
  };
  EXPECT_TRUE(runs(0.3));
  EXPECT_FALSE(runs(8));
}

/// How many run at a time changes nothing.
TEST(SetFit, RunsEveryPointAsThoughItWereAlone) {
  const test::ComparedDrive compared({}, test::seed(93));
  std::vector<Eigen::VectorXd> points;
  for (const double cubic : {-100.0, 10.0, 1e7, 300.0})
    points.push_back(Point{{0.1, 1.4, 20}, {spring(cubic)}}.numbers());
  const Parts parts = {hypothesis_of(effect::cubic_stiffness)};
  for (const unsigned threads : {1U, 3U}) {
    SimulatedModel model(compared.spectral, parts, nullptr, threads);
    const std::vector<Spectrum> all = model.residuals_at(points);
    ASSERT_EQ(all.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      Spectrum alone;
      Response response;
      SimulatedModel(compared.spectral, parts).evaluate(points[i], alone, response);
      EXPECT_EQ(all[i], alone) << threads << " " << i;
    }
  }
}

/// A spring that hardens on one side only, max(x - 0.1, 0), which no effect is: what the best cubic spring leaves of it
/// is no noise, and what a right one leaves is.
TEST(SetFit, WhatNoSetHoldsIsADiscrepancy) {
  const auto discrepancy_of = [](double cubic, double one_sided, std::uint64_t seed) {
    test::DrawnDrive what;
    what.torque = [=](double, double x, double) { return -cubic * x * x * x - one_sided * std::max(x - 0.1, 0.0); };
    const test::ComparedDrive compared(what, seed);
    const SetFitter fitter(compared.setting);
    const FittedSet found = fitter.fit(test::ComparedDrive::with(effect::cubic_stiffness), {what.wheel, {spring(100)}});
    return discrepancy_nats(found, fitter);
  };
  EXPECT_LT(discrepancy_of(100, 0, test::seed(93)), 6);
  EXPECT_GT(discrepancy_of(0, 60, test::seed(93)), 20);
}

}  // namespace
}  // namespace steerid::gap
