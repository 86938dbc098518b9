// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/set_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "gap/compared_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// In one round a search adds three effects at most: of four it has all where it begins beside them.
TEST(SetSearch, BeginsBesideWhatWasFoundUnderAnotherNoise) {
  test::DrawnDrive what;
  what.delay_s = 0.03;
  what.torque = [](double t, double x, double) {
    return 0.5 + 0.4 * std::sin(2 * std::numbers::pi * 1.3 * t) - 150 * x * x * x;
  };
  test::ComparedDrive compared(what, test::seed(101));
  compared.setting.out_of_time = [] { return true; };  // after the first round
  const auto of = [](const EffectType& type, std::vector<double> values) {
    Effect effect(type);
    effect.values = std::move(values);
    return effect;
  };
  Move four{.set = {}, .at = {what.wheel, {}}, .course = nullptr};
  four.set.wheel_given = false;
  for (const Effect& effect : {of(effect::delay, {what.delay_s}), of(effect::torque_bias, {0.5}),
                               of(effect::cubic_stiffness, {150}), of(effect::periodic_disturbance, {0.4, 1.3, 0})}) {
    four.set = with_added(four.set, *hypothesis_of(*effect.type));
    four.at.effects.push_back(effect);
  }
  EXPECT_LT(search_sets(compared.setting).answer().set.changes(), 4U);
  EXPECT_EQ(search_sets(compared.setting, {four}).answer().set.changes(), 4U);
}

}  // namespace
}  // namespace steerid::gap
