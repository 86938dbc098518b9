// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/effect_set.hpp"

#include <gtest/gtest.h>

#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

EffectSet set_of(std::initializer_list<std::pair<const EffectType*, Stands>> parts) {
  EffectSet set;
  for (const auto& [type, as] : parts) set.parts.push_back({hypothesis_of(*type), as});
  return set;
}

TEST(EffectSet, HoldsOneTorqueTwiceWhereBothOfItsSizesAreFree) {
  using enum Stands;
  const EffectType* asymmetric = &effect::asymmetric_friction;
  const EffectType* bias = &effect::torque_bias;
  EXPECT_TRUE(has_one_torque_twice(set_of({{asymmetric, kAdded}, {bias, kAdded}})));
  EXPECT_TRUE(has_one_torque_twice(set_of({{bias, kResized}, {asymmetric, kAdded}})));
  EXPECT_TRUE(has_one_torque_twice(set_of({{asymmetric, kResized}, {bias, kAdded}})));
  EXPECT_FALSE(has_one_torque_twice(set_of({{asymmetric, kGiven}, {bias, kAdded}})));
  EXPECT_FALSE(has_one_torque_twice(set_of({{bias, kGiven}, {asymmetric, kAdded}})));
  EXPECT_FALSE(has_one_torque_twice(set_of({{&effect::coulomb_friction, kAdded}, {bias, kAdded}})));
  EXPECT_FALSE(has_one_torque_twice(set_of({{asymmetric, kAdded}, {&effect::torque_drift, kAdded}})));
}

}  // namespace
}  // namespace steerid::gap
