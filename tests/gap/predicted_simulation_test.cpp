// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Someone else's simulator, known by its answer alone: the midpoint rule of drawn_drive.hpp, without sensor noise.
#include "gap/diagnosis/predicted_simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "gap/drawn_drive.hpp"
#include "log/bad_input.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// A prediction has little noise: 20 s of it determine what is asked for here.
test::DrawnDrive short_drive() {
  test::DrawnDrive what;
  what.duration_s = 20;
  return what;
}

/// The answer of the wheel `what` to the torques of the drive of this seed.
std::vector<double> answer_of(test::DrawnDrive what, std::uint64_t seed) {
  what.torque_noise_nm = what.angle_noise_rad = 0;
  return test::drive(what, seed).angle_rad;
}

const Effect* effect_of(const Simulation& simulation, std::string_view id) {
  const auto found = std::ranges::find(simulation.effects, id, [](const Effect& one) { return one.type->id; });
  return found == simulation.effects.end() ? nullptr : &*found;
}

DiagnoseOptions quick() {
  DiagnoseOptions options;
  options.figures = false;
  options.threads = 1;
  return options;
}

TEST(PredictedSimulation, ALinearOneIsKnownToAFewThousandths) {
  const test::DrawnDrive what = short_drive();
  const std::uint64_t seed = test::seed(81);
  const PredictedSimulation found = predicted_simulation(test::drive(what, seed), answer_of(what, seed), quick());
  EXPECT_TRUE(found.simulation.effects.empty());
  // A third of the deviations that the record leaves, some 0.1 % (docs/gap_diagnosis.md), three of them and rounding.
  EXPECT_NEAR(found.simulation.wheel.inertia_kgm2, 0.11, 0.004 * 0.11);
  EXPECT_NEAR(found.simulation.wheel.damping_nms_per_rad, 1.5, 0.004 * 1.5);
  EXPECT_NEAR(found.simulation.wheel.stiffness_nm_per_rad, 22.7, 0.004 * 22.7);
  EXPECT_LT(found.missed_nrmse, 0.01);
}

TEST(PredictedSimulation, WhatItHasIsFoundAndTheChangeIsStatedAgainstIt) {
  test::DrawnDrive theirs = short_drive();
  theirs.wheel = {0.12, 1.4, 24};
  theirs.dry_friction_nm = 0.4;
  test::DrawnDrive wheel = theirs;
  wheel.delay_s = 0.03;
  const std::uint64_t seed = test::seed(82);
  const Record record = test::drive(wheel, seed);
  const PredictedSimulation found = predicted_simulation(record, answer_of(theirs, seed), quick());
  ASSERT_NE(effect_of(found.simulation, "coulomb_friction"), nullptr);
  EXPECT_NEAR(effect_of(found.simulation, "coulomb_friction")->at("friction_nm"), 0.4, 0.01);
  EXPECT_NEAR(found.simulation.wheel.inertia_kgm2, 0.12, 0.01 * 0.12);
  EXPECT_EQ(found.simulation.effects.size(), 1U);
  const Diagnosis diagnosis = diagnose(record, found.simulation, quick());
  EXPECT_EQ(diagnosis.verdict, "delay");
  ASSERT_NE(effect_of(diagnosis.with_effect, "delay"), nullptr);
  EXPECT_NEAR(effect_of(diagnosis.with_effect, "delay")->at("delay_s"), 0.03, 0.001);
}

TEST(PredictedSimulation, AnAngleThatTellsNothingIsRefused) {
  const test::DrawnDrive what = short_drive();
  const Record record = test::drive(what, test::seed(83));
  EXPECT_THROW((void)predicted_simulation(record, std::vector<double>(record.size(), 0.1), quick()), BadInput);
}

}  // namespace
}  // namespace steerid::gap
