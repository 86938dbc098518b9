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

TEST(RestartedRun, AWheelRemembersAsLongAsItsSlowerTimeConstant) {
  EXPECT_DOUBLE_EQ(memory_s({0.1, 2.0, 20.0}), 0.1);  // B/C
  EXPECT_DOUBLE_EQ(memory_s({0.1, 0.1, 20.0}), 2.0);  // 2 J/B
  EXPECT_TRUE(std::isinf(memory_s({0.1, 0.1, 0.0})));
}

TEST(RestartedRun, WithASpringOneRunCoversTheRecord) {
  const Record record = quiet_record();
  const auto stretches = run_stretches(record, held_out_split(record), false);
  ASSERT_EQ(stretches.size(), 1U);
  EXPECT_EQ(stretches[0].first, 0U);
  EXPECT_EQ(stretches[0].count, record.size());
  EXPECT_FALSE(stretches[0].initial);
}

TEST(RestartedRun, AGapBeginsAnewAndTheOriginStays) {
  const Record record = quiet_record(30, 5);
  const auto stretches = run_stretches(record, held_out_split(record), false);
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

TEST(RestartedRun, WithoutASpringEveryBlockBeginsAnew) {
  const Record record = quiet_record();
  const std::vector<Block> blocks = held_out_split(record);
  const auto stretches = run_stretches(record, blocks, true);
  ASSERT_EQ(stretches.size(), blocks.size());
  // A constant torque on inertia alone, T t^2/2J from the start of each block, beside a line.
  Simulation simulation;
  simulation.wheel = {0.1, 0.0, 0.0};
  simulation.effects.emplace_back(find_effect("torque_bias"));
  simulation.effects[0].values = {0.02};
  const std::vector<double> angle = restarted_run(simulation, record, stretches);
  constexpr double kAcceleration = 0.02 / 0.1;
  for (const Block& block : blocks) {
    const std::size_t middle = block.first + block.count / 2;
    const std::size_t end = block.first + block.count - 1;
    const double t = 0.01 * static_cast<double>(end - middle);
    const std::size_t before = middle - (end - middle);
    EXPECT_NEAR(std::abs(angle[before] - 2 * angle[middle] + angle[end]), kAcceleration * t * t, 1e-6);
    EXPECT_LT(std::abs(angle[block.first]),
              kAcceleration / 2);  // what it moves by within the second that it is fitted to
  }
}

TEST(RestartedRun, KeepsTheStartsThatItFoundWhereItIsToldTo) {
  // A wheel that swings from 0.1 rad, recorded without a torque: -0.1 rad is where another record of it begins.
  const WheelArm wheel{0.1, 0.5, 20.0};
  Record record = quiet_record();
  const double decay_per_s = wheel.damping_nms_per_rad / (2 * wheel.inertia_kgm2);
  const double rad_s = std::sqrt(wheel.stiffness_nm_per_rad / wheel.inertia_kgm2 - decay_per_s * decay_per_s);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double t = record.time_s[i];
    record.angle_rad[i] = 0.1 * std::exp(-decay_per_s * t) * std::cos(rad_s * t);
  }
  RestartedRun run(record, run_stretches(record, held_out_split(record), false), TorqueSignal::Between::kBandLimited);
  run(wheel, {});
  run.keep_starts();
  ASSERT_TRUE(run.stretches().front().initial);
  EXPECT_NEAR(run.stretches().front().initial->angle_rad, 0.1, 1e-6);
  EXPECT_NEAR(run.stretches().front().initial->rate_rad_s, -0.1 * decay_per_s, 1e-5);
  // A wheel of three times the spring would be nearer to the first second from elsewhere.
  EXPECT_NEAR(run({0.1, 0.5, 60.0}, {}).front(), 0.1, 1e-6);
}

TEST(RestartedRun, WithoutASpringAnAngleThatIsRecordedLateIsNoOtherBeginning) {
  // J th'' + B th' = T sin(w t) beside what has decayed: th' = T/|Z| sin(w t - phi), Z = B + i w J.
  constexpr double kInertia = 0.05;
  constexpr double kDamping = 0.4;
  constexpr double kRate = 7;
  constexpr double kLate_s = 0.015;
  Record record = quiet_record();
  const double size = 1 / std::hypot(kDamping, kRate * kInertia) / kRate;
  const double phase = std::atan2(kRate * kInertia, kDamping);
  for (std::size_t i = 0; i < record.size(); ++i) {
    record.torque_driver_nm[i] = std::sin(kRate * record.time_s[i]);
    record.angle_rad[i] = -size * std::cos(kRate * (record.time_s[i] - kLate_s) - phase);
  }
  Simulation simulation;
  simulation.wheel = {kInertia, kDamping, 0};
  simulation.effects.emplace_back(find_effect("delay"));
  simulation.effects[0].values = {kLate_s};
  simulation.torque_between_samples = TorqueSignal::Between::kBandLimited;
  const std::vector<Block> blocks = held_out_split(record);
  const std::vector<double> angle = restarted_run(simulation, record, run_stretches(record, blocks, true));
  // Begun where the record is it would be off by the rate times the delay, up to 0.1 of the swing.
  for (const Block& block : blocks) {
    for (std::size_t i = block.first; i < block.first + block.count; ++i) {
      ASSERT_NEAR(angle[i], record.angle_rad[i], 0.01 * size) << "at " << record.time_s[i] << " s";
    }
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
