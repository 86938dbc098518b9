// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a fit of two effects may begin, on drives with both of them made by a route of their own (gap/drawn_drive.hpp).
#include "gap/pairs/pair_starts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "gap/comparison/comparison.hpp"
#include "gap/drawn_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

std::set<std::string_view> ids_of(const PairStart& start) { return {start.first->type().id, start.second->type().id}; }

/// The three best pairs of a drive and the one with a grip, by the simulation whose J, B and C are off by five percent.
std::vector<PairStart> best_of(const test::DrawnDrive& what, std::uint64_t seed, const EffectType& leading) {
  const Record record = test::drive(what, test::seed(seed));
  const WheelArm given = test::off_by_five_percent(what.wheel).wheel;
  const SpectralRecord spectral(record, given, held_out_split(record, 100), 100, false);
  const auto any = [](const EffectType& type) {
    return type.id != "stribeck_friction" && type.id != "asymmetric_friction";
  };
  const auto together = [](const EffectType& one, const EffectType& other) { return goes_with(other, {Effect(one)}); };
  std::vector<PairStart> starts = pair_starts(spectral, given, 3, leading, any, together);
  EXPECT_EQ(starts.size(), 4U);
  EXPECT_TRUE(std::ranges::is_sorted(starts, {}, &PairStart::left));
  EXPECT_EQ(ids_of(starts.back()), (std::set<std::string_view>{leading.id, "compliance"}));
  return starts;
}

/// A value of one of the two effects, by its place among its effect's.
double value_of(const PairStart& start, std::string_view id, std::size_t place = 0) {
  const bool second = start.second->type().id == id;
  const std::size_t before = 3 + (second ? start.first->type().parameters.size() : 0);
  return start.x[static_cast<Eigen::Index>(before + place)];
}

TEST(PairStarts, FindsFrictionAndWhatStandsBesideIt) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.9;  // half of the applied torque
  what.torque = [](double, double, double v) { return -3 * v * std::abs(v); };
  const PairStart start = best_of(what, 82, effect::coulomb_friction).at(0);
  EXPECT_EQ(ids_of(start), (std::set<std::string_view>{"coulomb_friction", "quadratic_damping"}));
  // From there a fit by free runs has found its optimum on every record that was tried.
  EXPECT_NEAR(value_of(start, "coulomb_friction"), 0.9, 0.3);
  EXPECT_NEAR(value_of(start, "quadratic_damping"), 3, 1.5);
  EXPECT_NEAR(start.x[0], what.wheel.inertia_kgm2, 0.2 * what.wheel.inertia_kgm2);
  EXPECT_NEAR(start.x[2], what.wheel.stiffness_nm_per_rad, 0.2 * what.wheel.stiffness_nm_per_rad);
}

TEST(PairStarts, FindsADelayBesideASpring) {
  test::DrawnDrive what;
  what.delay_s = 0.04;
  what.torque = [](double, double x, double) { return -900 * x * x * x; };
  // A lag of the same size looks nearly alike to a balance that no differentiation sharpens: both are offered.
  const std::vector<PairStart> starts = best_of(what, 83, effect::cubic_stiffness);
  const auto found = std::ranges::find(starts, std::set<std::string_view>{"cubic_stiffness", "delay"}, ids_of);
  ASSERT_NE(found, starts.end());
  EXPECT_NEAR(value_of(*found, "delay"), 0.04, 0.011);  // half a step of those tried
  EXPECT_NEAR(value_of(*found, "cubic_stiffness"), 900, 450);
}

}  // namespace
}  // namespace steerid
