// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "gap/compared_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// In one round a search adds three effects at most: of four it has all where it begins beside them.
class FourEffects : public ::testing::Test {
 protected:
  FourEffects() : compared_(what(), test::seed(101)), four_{.set = {}, .at = {what().wheel, {}}, .course = nullptr} {
    compared_.setting.out_of_time = [] { return true; };  // after the first round
    four_.set.wheel_given = false;
    add(effect::delay, {what().delay_s});
    add(effect::torque_bias, {0.5});
    add(effect::cubic_stiffness, {150});
    add(effect::periodic_disturbance, {0.4, 1.3, 0});
  }

  static test::DrawnDrive what() {
    test::DrawnDrive drive;
    drive.delay_s = 0.03;
    drive.torque = [](double t, double x, double) {
      return 0.5 + 0.4 * std::sin(2 * std::numbers::pi * 1.3 * t) - 150 * x * x * x;
    };
    return drive;
  }

  void add(const EffectType& type, std::vector<double> values) {
    four_.set = with_added(four_.set, *hypothesis_of(type));
    four_.at.effects.emplace_back(type);
    four_.at.effects.back().values = std::move(values);
  }

  test::ComparedDrive compared_;
  Move four_;
};

TEST_F(FourEffects, AreFoundBesideWhatWasFoundUnderAnotherNoise) {
  EXPECT_LT(search_sets(compared_.setting).answer().set.changes(), 4U);
  EXPECT_EQ(search_sets(compared_.setting, {four_}).answer().set.changes(), 4U);
}

/// An unmeasured torque of no more than every driver's is none.
TEST_F(FourEffects, AreFoundInASetThatHoldsWhatEveryRecordHas) {
  four_.set.slow = SlowTorque::kCause;
  const SearchedSets found = search_sets(compared_.setting, {four_});
  ASSERT_NE(found.find(four_.set), nullptr);
  ASSERT_FALSE(found.find(four_.set)->eligible);
  EXPECT_EQ(found.answer().set.changes(), 4U);
  EXPECT_EQ(found.answer().set.slow, SlowTorque::kFloor);
}

/// Friction that differs between the ways is Coulomb's where it does not differ, and no other name for it there. A fit
/// that was left on the way, where it does, is further from the record: no answer.
TEST(SetSearch, KeepsASetWhereItIsLikeliest) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.8;
  what.bristle_rad = 0.0004;
  test::ComparedDrive compared(what, test::seed(102));
  compared.setting.out_of_time = [] { return true; };  // after the first round
  const EffectSet set = test::ComparedDrive::with(effect::asymmetric_friction);
  Effect friction(effect::asymmetric_friction);
  const double one_percent_nm = 0.01 * compared.spectral.applied_rms_nm;
  int left_on_the_way = 0;
  for (const auto& values : {std::vector{0.0, 2.0, 0.002}, {0.05, 2.0, 0.0015}, {0.0, 1.5, 0.0003}}) {
    friction.values = values;
    const FittedSet begun = SetFitter(compared.setting).fit(set, {what.wheel, {friction}});
    const Effect differs = begun.at().effects.front();
    if (std::abs(differs.values[0] - differs.values[1]) / 2 < one_percent_nm) continue;
    ++left_on_the_way;
    const SearchedSets found = search_sets(compared.setting, {{set, {what.wheel, {friction}}, nullptr}});
    EXPECT_FALSE(found.find(set)->eligible);
    EXPECT_LT(found.find(set)->nats(), begun.nats() - 10);
  }
  EXPECT_GT(left_on_the_way, 0);
}

}  // namespace
}  // namespace steerid::gap
