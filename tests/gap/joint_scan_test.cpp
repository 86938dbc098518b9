// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Effects looked for together, in drives of an integrator of their own (gap/drawn_drive.hpp).
#include "gap/sets/joint_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gap/compared_drive.hpp"
#include "gap/likelihood/prior.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/sets/set_fit.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// What is missing beside a simulation without effects, whose J, B and C are the drive's.
std::vector<JointStart> missing_in(const test::DrawnDrive& what, std::uint64_t seed, std::size_t count = 2) {
  const test::ComparedDrive compared(what, seed);
  const WheelArm& wheel = what.wheel;
  EffectSet set;
  const Parts parts;
  const FittedSet near = SetFitter(compared.setting).fit(set, {wheel});
  std::vector<Spectrum> slopes = RunSlopes(compared.spectral, parts).at(near.fit.x, fitted_parameters(wheel, parts));
  LinearScan scan(compared.spectral, parts, near.fit, kSeen, {}, slopes);
  const SearchOrigin origin{std::move(scan), near.at(), compared.record, std::move(slopes)};
  std::vector<JointCandidate> candidates;
  for (const auto& hypothesis : hypotheses()) {
    candidates.push_back({hypothesis.get(), starting_points(*hypothesis, compared.spectral, origin)});
  }
  return joint_starts({compared.spectral, parts, origin, {}, kUsualError}, candidates, count);
}

bool has(const JointStart& start, Hypothesis::Family family) {
  return std::ranges::any_of(start.added, [&](const Hypothesis* one) { return one->family() == family; });
}

/// Friction and a late angle at once: the best single effect makes up for the other, and leaves J, B and C elsewhere.
TEST(JointScan, FindsTwoEffectsThatActTogether) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.5;
  what.lag_s = 0.025;
  const std::vector<JointStart> starts = missing_in(what, test::seed(111));
  ASSERT_FALSE(starts.empty());
  ASSERT_EQ(starts.front().added.size(), 2U);
  EXPECT_TRUE(has(starts.front(), Hypothesis::Family::kFriction));
  EXPECT_TRUE(has(starts.front(), Hypothesis::Family::kLateness));
}

/// A weight of 6 Nm beside them, a quarter of C that is not quite a spring.
TEST(JointScan, FindsThreeEffectsThatActTogether) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.5;
  what.lag_s = 0.025;
  what.torque = [](double, double x, double) { return -6.0 * std::sin(x + 0.4); };
  const std::vector<JointStart> starts = missing_in(what, test::seed(112));
  const auto three = std::ranges::find(starts, 3U, [](const JointStart& one) { return one.added.size(); });
  ASSERT_NE(three, starts.end());
  EXPECT_TRUE(has(*three, Hypothesis::Family::kFriction));
  EXPECT_TRUE(has(*three, Hypothesis::Family::kLateness));
  const auto is_weight = [](const Hypothesis* one) { return &one->type() == &effect::gravity_imbalance; };
  EXPECT_TRUE(std::ranges::any_of(three->added, is_weight));
}

/// An arm behind a gap and one behind a spring each say how it joins the wheel. Where a gap is missing both help.
TEST(JointScan, PutsNothingTogetherThatNoSimulationCanHold) {
  test::DrawnDrive what;
  what.torque = [stiffness = what.wheel.stiffness_nm_per_rad](double, double x, double) {
    return stiffness * std::clamp(x, -0.03, 0.03);
  };
  constexpr std::size_t kMany = 200;
  const std::vector<JointStart> starts = missing_in(what, test::seed(113), kMany);
  const auto adds = [](const JointStart& start, const EffectType& type) {
    return std::ranges::any_of(start.added, [&](const Hypothesis* one) { return &one->type() == &type; });
  };
  EXPECT_TRUE(std::ranges::any_of(starts, [&](const JointStart& one) { return adds(one, effect::backlash); }));
  EXPECT_TRUE(std::ranges::any_of(starts, [&](const JointStart& one) { return adds(one, effect::compliance); }));
  for (const JointStart& one : starts) EXPECT_NO_THROW(check_compatible(one.at.effects));
}

}  // namespace
}  // namespace steerid::gap
