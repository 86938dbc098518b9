// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Effects looked for together, in drives of an integrator of their own (gap/drawn_drive.hpp).
#include "gap/sets/joint_scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gap/compared_drive.hpp"
#include "gap/model/run_slopes.hpp"
#include "gap/sets/set_fit.hpp"
#include "gap/sets/wheel_shift.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// What is missing beside a simulation without effects, whose J, B and C are the drive's.
std::vector<JointStart> missing_in(const test::DrawnDrive& what, std::uint64_t seed) {
  const test::ComparedDrive compared(what, seed);
  const WheelArm& wheel = what.wheel;
  EffectSet set;
  const SpectralModel::Parts parts;
  const FittedSet near = SetFitter(compared.setting).fit(set, joined(wheel, {}));
  const std::vector<Spectrum> slopes =
      RunSlopes(compared.spectral, parts).at(near.fit.x, fitted_parameters(wheel, wheel, parts));
  const SearchOrigin origin{LinearScan(compared.spectral, compared.whittle, parts, near.fit, kSeen, {}, slopes),
                            near.fit.x, compared.record};
  std::vector<JointCandidate> candidates;
  for (const auto& hypothesis : hypotheses()) {
    candidates.push_back({hypothesis.get(), starting_points(*hypothesis, compared.spectral, origin)});
  }
  return joint_starts({compared.spectral, compared.whittle, parts, near.fit, {}, slopes, kUsualError}, candidates, 2);
}

bool has(const JointStart& start, const EffectType& type) {
  return std::ranges::any_of(start.added, [&](const Hypothesis* one) { return &one->type() == &type; });
}

/// Friction and a weight at once. The best single effect makes up for the others; together they are told.
TEST(JointScan, FindsEffectsThatStandTogether) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.5;
  what.torque = [](double, double x, double) { return -2.0 * std::sin(x + 0.4); };
  const std::vector<JointStart> starts = missing_in(what, test::seed(111));
  ASSERT_FALSE(starts.empty());
  const JointStart& pair = starts.front();
  ASSERT_EQ(pair.added.size(), 2U);
  EXPECT_TRUE(has(pair, effect::gravity_imbalance));
  const auto of_friction = [](const Hypothesis* one) { return one->family() == Hypothesis::Family::kFriction; };
  EXPECT_TRUE(std::ranges::any_of(pair.added, of_friction));
  EXPECT_GT(pair.nats, 1000);
}

/// Where nothing is missing no effect takes off what a number costs: of 20 drives two subsets at most, as each needs
/// two effects of chance beyond 2.8 deviations (1 in 200 for one of some 60 starting values).
TEST(JointScan, FindsNothingInNoise) {
  std::size_t found = 0;
  for (std::uint64_t i = 0; i < 20; ++i) {
    test::DrawnDrive what;
    what.duration_s = 30;
    found += missing_in(what, test::seed(120) + i).empty() ? 0 : 1;
  }
  EXPECT_LE(found, 2U);
}

}  // namespace
}  // namespace steerid::gap
