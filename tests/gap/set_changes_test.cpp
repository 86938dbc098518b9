// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Simulations that have effects, against drives of an integrator of their own (drawn_drive.hpp).
#include <gtest/gtest.h>

#include <cmath>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/drawn_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr double kWeight_nm = 1.2;
constexpr double kPhase_rad = 0.4;

test::DrawnDrive with_weight() {
  test::DrawnDrive what;
  what.duration_s = 40;
  what.torque = [](double, double angle, double) { return -kWeight_nm * std::sin(angle + kPhase_rad); };
  return what;
}

Simulation of(const WheelArm& wheel, double weight_nm) {
  Simulation simulation = test::off_by_five_percent(wheel);
  Effect& weight = simulation.effects.emplace_back(effect::gravity_imbalance);
  weight.at("weight_torque_nm") = weight_nm;
  weight.at("phase_rad") = kPhase_rad;
  return simulation;
}

Diagnosis diagnosed(const test::DrawnDrive& what, const Simulation& simulation, std::uint64_t seed) {
  DiagnoseOptions options;
  options.threads = 1;
  options.figures = false;
  return diagnose(test::drive(what, seed), simulation, options);
}

/// A weight is nearly a spring: with another C it makes up for much, and its size was once moved for what was missing.
TEST(SetChanges, WhatIsMissingIsAddedAndWhatIsRightStays) {
  test::DrawnDrive what = with_weight();
  what.lag_s = 0.025;
  const Diagnosis found = diagnosed(what, of(what.wheel, kWeight_nm), test::seed(91));
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes.front().effect.type, &effect::lag);
  EXPECT_EQ(found.causes.front().change, ChangeKind::kAdd);
  EXPECT_NEAR(found.causes.front().effect.values.front(), 0.025, 0.001);
  EXPECT_TRUE(found.unexplained.complete);
}

TEST(SetChanges, WhatHasAnotherSizeIsResizedBesideWhatIsMissing) {
  test::DrawnDrive what;
  what.duration_s = 40;
  what.dry_friction_nm = 0.4;
  what.lag_s = 0.025;
  Simulation simulation = test::off_by_five_percent(what.wheel);
  simulation.effects.emplace_back(effect::coulomb_friction).at("friction_nm") = 0.8;
  const Diagnosis found = diagnosed(what, simulation, test::seed(92));
  ASSERT_EQ(found.causes.size(), 2U);
  for (const Cause& cause : found.causes) {
    const bool lag = cause.effect.type == &effect::lag;
    EXPECT_EQ(cause.change, lag ? ChangeKind::kAdd : ChangeKind::kResize);
    EXPECT_EQ(cause.was.has_value(), !lag);
    EXPECT_NEAR(cause.effect.values.front(), lag ? 0.025 : 0.4, lag ? 0.002 : 0.02);
  }
}

/// Asymmetric friction beside a bias of another size moves the wheel in the same way, with a number more.
TEST(SetChanges, FrictionBesideABiasThatTheWheelDoesNotHaveIsNoAsymmetricFriction) {
  test::DrawnDrive what;
  what.duration_s = 40;
  what.dry_friction_nm = 0.4;
  Simulation simulation;
  simulation.wheel = what.wheel;
  simulation.effects.emplace_back(effect::torque_bias).at("bias_nm") = 0.3;
  const Diagnosis found = diagnosed(what, simulation, test::seed(93));
  ASSERT_EQ(found.causes.size(), 2U);
  for (const Cause& cause : found.causes) {
    const bool friction = cause.effect.type == &effect::coulomb_friction;
    EXPECT_TRUE(friction || cause.effect.type == &effect::torque_bias) << cause.effect.type->id;
    EXPECT_EQ(cause.change, friction ? ChangeKind::kAdd : ChangeKind::kRemove);
    EXPECT_NEAR(cause.effect.values.front(), friction ? 0.4 : 0.3, 0.02);
  }
}

}  // namespace
}  // namespace steerid::gap
