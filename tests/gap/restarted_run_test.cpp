// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where free runs begin anew, against closed forms: the wheel without a spring under a torque that nobody measured.
#include "gap/model/restarted_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "plant/effects/vocabulary.hpp"

namespace steerid::gap {
namespace {

/// 60 s at 100 Hz in which nothing is measured to happen, with a hole when asked for.
Record quiet_record(double gap_from_s = 1e9, double gap_s = 0) {
  Record record;
  for (int i = 0; i < 6000; ++i) {
    const double t = 0.01 * i;
    record.time_s.push_back(t < gap_from_s ? t : t + gap_s);
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(0);
  }
  return record;
}

MeasuredMotion still(const Record& record) {
  const std::vector<double> zero(record.size(), 0.0);
  return {record.time_s, zero, zero, zero};
}

TEST(RestartedRun, AWheelRemembersAsLongAsItsSlowerTimeConstant) {
  EXPECT_DOUBLE_EQ(memory_s({0.1, 2.0, 20.0}), 0.1);  // B/C
  EXPECT_DOUBLE_EQ(memory_s({0.1, 0.1, 20.0}), 2.0);  // 2 J/B
  EXPECT_TRUE(std::isinf(memory_s({0.1, 0.1, 0.0})));
}

TEST(RestartedRun, WithASpringOneRunCoversTheRecord) {
  const Record record = quiet_record();
  const auto stretches = run_stretches(record, held_out_split(record, 100), still(record), false);
  ASSERT_EQ(stretches.size(), 1U);
  EXPECT_EQ(stretches[0].first, 0U);
  EXPECT_EQ(stretches[0].count, record.size());
  EXPECT_FALSE(stretches[0].initial);
}

TEST(RestartedRun, AGapBeginsAnewAndTheOriginStays) {
  const Record record = quiet_record(30, 5);
  const auto stretches = run_stretches(record, held_out_split(record, 100), still(record), false);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[1].first, 3000U);
  // A torque that creeps to 1 Nm with 60 s: after the gap it is what it is at that time, not zero again.
  Simulation simulation;
  simulation.wheel = {0.1, 1.0, 20.0};
  simulation.effects.emplace_back(find_effect("torque_drift"));
  simulation.effects[0].values = {1.0, 60.0};
  const std::vector<double> angle = restarted_run(simulation, record, stretches);
  const double expected_rad = (1 - std::exp(-record.time_s[5500] / 60)) / 20;
  EXPECT_NEAR(std::abs(angle[5500]), expected_rad, 0.01 * expected_rad);
}

TEST(RestartedRun, WithoutASpringEveryBlockBeginsWhereTheWheelWas) {
  const Record record = quiet_record();
  const std::vector<Block> blocks = held_out_split(record, 100);
  const auto stretches = run_stretches(record, blocks, still(record), true);
  ASSERT_EQ(stretches.size(), blocks.size());
  // A constant torque on inertia alone: T t^2/2J from the start of each block.
  Simulation simulation;
  simulation.wheel = {0.1, 0.0, 0.0};
  simulation.effects.emplace_back(find_effect("torque_bias"));
  simulation.effects[0].values = {0.02};
  const std::vector<double> angle = restarted_run(simulation, record, stretches);
  for (const Block& block : blocks) {
    const double t = 0.01 * static_cast<double>(block.count - 1);
    EXPECT_NEAR(std::abs(angle[block.first + block.count - 1]), 0.02 * t * t / 2 / 0.1, 1e-4);
    EXPECT_EQ(angle[block.first], 0);
  }
}

TEST(RestartedRun, TheSpringOfARunIsWhatAConstantTorqueSees) {
  // rms over 0..T of t^2/2J, and of t/B: closed forms.
  constexpr double kT = 4.0;
  EXPECT_NEAR(1 / within_run({0.1, 0, 0}, kT).stiffness_nm_per_rad, kT * kT / 2 / 0.1 / std::sqrt(5.0), 1e-9);
  EXPECT_NEAR(1 / within_run({1e-12, 2.0, 0}, kT).stiffness_nm_per_rad, kT / 2.0 / std::sqrt(3.0), 1e-9);
  EXPECT_EQ(within_run({0.1, 2.0, 30}, kT).stiffness_nm_per_rad, 30);
}

/// Of one run over a quiet minute that begins a hundredth of a radian out.
bool holds(const WheelArm& wheel, std::vector<Effect> effects = {}) {
  Record record = quiet_record();
  record.angle_rad.front() = 0.01;
  const std::vector<RunStretch> stretches = {{0, record.size(), WheelState{0.01, 0}}};
  return holds_itself(record, stretches, wheel, effects, TorqueSignal::Between::kHeld);
}

TEST(RestartedRun, ALinearWheelHoldsItselfByASpringAndADampingAboveZero) {
  EXPECT_TRUE(holds({0.1, 0.2, 10}));
  EXPECT_FALSE(holds({0.1, 0.2, -1}));
  EXPECT_FALSE(holds({0.1, -0.02, 10}));
}

TEST(RestartedRun, AReflexShakesAWheelWhoseDampingIsLessThanItTakes) {
  // Where it swings, J w^2 = C + K cos(w d), a reflex that is late by d takes K sin(w d)/w of the damping.
  constexpr double kInertia = 0.1;
  constexpr double kDelay_s = 0.05;
  constexpr double kReflex = 5;
  constexpr double kRate = 12;
  const double stiffness = kInertia * kRate * kRate - kReflex * std::cos(kRate * kDelay_s);
  const double taken = kReflex * std::sin(kRate * kDelay_s) / kRate;
  Effect reflex(effect::reflex);
  reflex.at("reflex_stiffness_nm_per_rad") = kReflex;
  reflex.at("delay_s") = kDelay_s;
  reflex.at("time_constant_s") = 1e-4;
  reflex.at("low_pass_shape") = 0;
  EXPECT_TRUE(holds({kInertia, 1.05 * taken, stiffness}, {reflex}));
  EXPECT_FALSE(holds({kInertia, 0.95 * taken, stiffness}, {reflex}));
}

TEST(RestartedRun, ASofteningSpringLetsAWheelGoBeyondItsTop) {
  // C q = c q^3 at q = 0.01 rad, sqrt(C/c).
  Effect softer(effect::cubic_stiffness);
  softer.at("cubic_stiffness_nm_per_rad3") = -1.1e5;
  EXPECT_FALSE(holds({0.1, 1, 10}, {softer}));
  softer.at("cubic_stiffness_nm_per_rad3") = -0.5e5;
  EXPECT_TRUE(holds({0.1, 1, 10}, {softer}));
}

}  // namespace
}  // namespace steerid::gap
