// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The 100 Hz task on a steering column: its equation, and an arm that is identified above the torsion bar.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "app/task.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "support/seed.hpp"
#include "support/steered_column.hpp"

namespace steerid {
namespace {

const test::SteeredColumn kColumn{.intent_rad = 0.05, .probe_nm = 1};

std::vector<Sample> samples_of(const test::SteeredColumn& column, double duration_s, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Sample> samples;
  for (const test::ColumnRow& row : test::drive(column, duration_s, random)) {
    samples.push_back(test::sample_of(row, static_cast<std::int64_t>(samples.size())));
  }
  return samples;
}

/// Within four of the deviations that are published.
void expect_the_arm(const Estimate& estimate) {
  const auto near = [](const ParameterEstimate& p, double truth) {
    EXPECT_NEAR(p.value_micro, 1e6 * truth, 4.0 * p.sd_micro);
    EXPECT_LT(p.sd_micro, 0.2e6 * truth);
    EXPECT_EQ(p.state, ParameterState::kValid);
  };
  near(estimate.inertia, kColumn.inertia_kgm2);
  near(estimate.damping, kColumn.damping_nms_per_rad);
  near(estimate.stiffness, kColumn.stiffness_nm_per_rad);
}

template <class Scalar>
void expect_the_arm_above_the_bar() {
  IdentificationTask<Scalar> task;
  EXPECT_EQ(task.equation(), Equation::kNone);
  for (const Sample& sample : samples_of(kColumn, 60, test::seed(80))) task.take(sample);
  EXPECT_EQ(task.equation(), Equation::kBar);
  EXPECT_FALSE(task.fault());
  expect_the_arm(task.estimate());
}

/// What a task is told of a wheel with dry friction of 0.1 Nm above the bar.
template <class Scalar>
constexpr ClosedLoopSettings<Scalar> kRough{.wheel = {.friction_nm = Scalar(0.1)}};
constexpr double kFriction_nm = 0.1;

template <class Scalar>
Estimate of_a_rough_wheel(const ClosedLoopSettings<Scalar>& settings, std::uint64_t seed) {
  test::SteeredColumn column = kColumn;
  column.wheel_friction_nm = kFriction_nm;
  IdentificationTask<Scalar> task(kSteeringWheel<Scalar>, InputSupervision::kSteeringWheel, Probe::kGentle, settings);
  for (const Sample& sample : samples_of(column, 60, seed)) task.take(sample);
  return task.estimate();
}

// Friction that the task is not told of is damping to it: 30 % of B, and valid.
template <class Scalar>
void expect_the_arm_on_a_rough_wheel() {
  const std::uint64_t seed = test::seed(88);
  expect_the_arm(of_a_rough_wheel(kRough<Scalar>, seed));
  const ParameterEstimate untold = of_a_rough_wheel(kSteeringColumn<Scalar>, seed).damping;
  EXPECT_GT(untold.value_micro, 1.2e6 * kColumn.damping_nms_per_rad);
}
TEST(TaskOnAColumn, TakesTheFrictionOfTheWheelOffTheBarInFloat) { expect_the_arm_on_a_rough_wheel<float>(); }
TEST(TaskOnAColumn, TakesTheFrictionOfTheWheelOffTheBarInFixedPoint) { expect_the_arm_on_a_rough_wheel<Fixed>(); }

TEST(TaskOnAColumn, IdentifiesTheArmOfADriverWhoSteersInFloat) { expect_the_arm_above_the_bar<float>(); }
TEST(TaskOnAColumn, IdentifiesTheArmOfADriverWhoSteersInFixedPoint) { expect_the_arm_above_the_bar<Fixed>(); }

// The task's own request stands for a `probe` channel that the bus does not have; it comes one tick later.
TEST(TaskOnAColumn, KnowsTheProbeThatItAskedFor) {
  IdentificationTask<float> task;
  task.permit_probe(true);
  std::int32_t asked_mnm = 0;
  Sample sample = samples_of(kColumn, 0.02, test::seed(81)).front();
  sample.valid_bits = kAngleValid | kTorqueBarValid;
  bool by_probe = false;
  for (int tick = 0; tick < 1500; ++tick) {
    sample.stamp_us = tick * kTickPeriodUs;
    sample.angle_urad = 1000 * (tick % 7);
    sample.torque_bar_mnm += tick % 2 == 0 ? 1 : -1;
    task.take(sample);
    by_probe = by_probe || task.identifier().follower().by_probe();
    asked_mnm = task.probe_torque_mnm();
  }
  EXPECT_NE(asked_mnm, 0);
  EXPECT_TRUE(by_probe);
}

// Of a probe that was never applied nothing can be told, and what the task asked for is no sign that it was.
TEST(TaskOnAColumn, LearnsNothingByAProbeThatWasRefused) {
  test::SteeredColumn column = kColumn;
  column.probe_nm = 0;
  IdentificationTask<float> task;
  task.permit_probe(true);
  int asked = 0;
  int valid = 0;
  for (Sample& sample : samples_of(column, 200, test::seed(83))) {
    sample.valid_bits = kAngleValid | kTorqueBarValid;
    task.take(sample);
    asked += task.probe_torque_mnm() != 0;
    task.probe_was_refused();
    valid += task.estimate().stiffness.state == ParameterState::kValid;
  }
  EXPECT_GT(asked, 10'000);
  EXPECT_EQ(valid, 0);
}

// A driver's torque that is lost for good leaves the torsion bar, and what is learned from it.
TEST(TaskOnAColumn, GoesOnAboveTheBarWhenTheDriversTorqueIsLost) {
  IdentificationTask<float> task;
  std::vector<Sample> samples = samples_of(kColumn, 70, test::seed(82));
  for (std::size_t k = 0; k < 500; ++k) {
    samples[k].valid_bits |= kTorqueDriverValid;
    task.take(samples[k]);
  }
  EXPECT_EQ(task.equation(), Equation::kDriverBar);
  for (std::size_t k = 500; k < 599; ++k) task.take(samples[k]);
  EXPECT_EQ(task.equation(), Equation::kDriverBar);
  EXPECT_TRUE(task.fault());
  task.take(samples[599]);
  EXPECT_EQ(task.equation(), Equation::kBar);
  EXPECT_FALSE(task.fault());
  EXPECT_EQ(task.estimate().inertia.state, ParameterState::kStarting);  // of the other equation nothing is kept
  for (std::size_t k = 600; k < samples.size(); ++k) task.take(samples[k]);
  expect_the_arm(task.estimate());
}

TEST(TaskOnAColumn, GoesOnFromWhatItSaved) {
  const std::vector<Sample> samples = samples_of(kColumn, 60, test::seed(83));
  IdentificationTask<float> task;
  for (const Sample& sample : samples) task.take(sample);
  SavedEstimate saved;
  ASSERT_EQ(task.save(saved), Status::kOk);
  IdentificationTask<float> next;
  ASSERT_EQ(next.restore(saved), Status::kOk);
  EXPECT_EQ(next.estimate().inertia.state, ParameterState::kHolding);
  for (std::size_t k = 0; k < 3; ++k) next.take(samples[k]);
  EXPECT_EQ(next.estimate().inertia.state, ParameterState::kHolding);  // the first equation is no change of it
  EXPECT_NEAR(next.estimate().stiffness.value_micro, saved.value_micro[2], 1);
  for (std::size_t k = 3; k < 3000; ++k) next.take(samples[k]);
  expect_the_arm(next.estimate());
}

/// Seconds after 25 s, when the hands leave for ten seconds, until that is told, or -1; and how long it was told
/// before.
struct Told {
  double after_s = -1;
  int falsely_ticks = 0;
};
Told told(std::uint64_t seed, double wheel_friction_nm = 0,
          const ClosedLoopSettings<float>& settings = kSteeringColumn<float>) {
  test::SteeredColumn column{.intent_rad = 0.05, .probe_nm = 1};
  column.let_go_from_s = 25;
  column.let_go_for_s = 10;
  column.wheel_friction_nm = wheel_friction_nm;
  IdentificationTask<float> task(kSteeringWheel<float>, InputSupervision::kSteeringWheel, Probe::kGentle, settings);
  Told result;
  for (const Sample& sample : samples_of(column, 35, seed)) {
    task.take(sample);
    if (task.estimate().driver != DriverState::kHandsOff) continue;
    const double after_s = 1e-6 * static_cast<double>(sample.stamp_us) - 25;
    if (after_s < 0) {
      ++result.falsely_ticks;
    } else if (result.after_s < 0) {
      result.after_s = after_s;
    }
  }
  return result;
}

// Ten releases under a probe of 1 Nm rms, 22 Nm/rad of arm before and 15 Nm/rad of rack below the bar all the time.
TEST(TaskOnAColumn, TellsThatTheHandsHaveLeftAboveARackThatCentres) {
  const std::uint64_t first = test::seed(90);
  int within_6_s = 0;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Told one = told(first + i);
    EXPECT_EQ(one.falsely_ticks, 0) << i;
    within_6_s += one.after_s >= 0 && one.after_s <= 6;
  }
  EXPECT_GE(within_6_s, 9);
}

TEST(TaskOnAColumn, TellsThatTheHandsHaveLeftARoughWheelOnlyWhereItIsToldOfIt) {
  const std::uint64_t first = test::seed(90);
  int told_of_it = 0;
  int untold = 0;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Told one = told(first + i, kFriction_nm, kRough<float>);
    EXPECT_EQ(one.falsely_ticks, 0) << i;
    told_of_it += one.after_s >= 0;
    untold += told(first + i, kFriction_nm).after_s >= 0;
  }
  EXPECT_GE(told_of_it, 5);
  EXPECT_LE(untold, 2);
}

// A gateway that repeats its last message, or a bar without supply, looks like a wheel that nobody holds.
TEST(TaskOnAColumn, HoldsWhatItKnewWhileASensorReadsTheSame) {
  const std::vector<Sample> samples = samples_of(kColumn, 100, test::seed(85));
  enum Frozen { kBoth, kAngle, kBar };
  for (const Frozen frozen : {kBoth, kAngle, kBar}) {
    SCOPED_TRACE(frozen);
    IdentificationTask<float> task;
    Estimate estimate;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      Sample sample = samples[k];
      if (k >= 6000 && k < 8000) {
        if (frozen != kBar) sample.angle_urad = samples[6000].angle_urad;
        if (frozen != kAngle) sample.torque_bar_mnm = samples[6000].torque_bar_mnm;
      }
      task.take(sample);
      estimate = task.estimate();
      if (k < 6050 || k >= 8000) continue;
      ASSERT_NE(estimate.stiffness.state, ParameterState::kValid) << k;
      ASSERT_NE(estimate.driver, DriverState::kHandsOff) << k;
    }
    expect_the_arm(estimate);
  }
}

// Of readings that stay the same the stamps say nothing either: every second sample is lost, and the rate is no other.
TEST(TaskOnAColumn, KeepsItsPeriodWhileASensorReadsTheSame) {
  const std::vector<Sample> samples = samples_of(kColumn, 90, test::seed(87));
  IdentificationTask<float> task;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    Sample sample = samples[k];
    if (k >= 6000) {
      if (k % 2 == 1) continue;
      sample.angle_urad = samples[6000].angle_urad;
      sample.torque_bar_mnm = samples[6000].torque_bar_mnm;
    }
    task.take(sample);
  }
  EXPECT_EQ(task.estimate().inertia.state, ParameterState::kHolding);
  EXPECT_NEAR(task.estimate().inertia.value_micro, 1e6 * kColumn.inertia_kgm2, 0.2e6 * kColumn.inertia_kgm2);
}

TEST(TaskOnAColumn, TakesABarWithoutSupplyForNoReleasedWheel) {
  std::vector<Sample> samples = samples_of(kColumn, 100, test::seed(86));
  std::mt19937_64 random(test::seed(86));
  std::normal_distribution<double> noise_mnm(0, 5);
  IdentificationTask<float> task;
  int told = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k >= 6000) samples[k].torque_bar_mnm = static_cast<std::int32_t>(noise_mnm(random));
    task.take(samples[k]);
    told += task.estimate().driver == DriverState::kHandsOff;
  }
  EXPECT_EQ(told, 0);
}

TEST(TaskOnAColumn, TellsNothingOfTheHandsInAFault) {
  test::SteeredColumn column{.intent_rad = 0.05, .probe_nm = 1};
  column.let_go_from_s = 25;
  column.let_go_for_s = 30;
  IdentificationTask<float> task;
  for (const Sample& sample : samples_of(column, 50, test::seed(90))) {
    task.take(sample);
    if (task.estimate().driver == DriverState::kHandsOff) break;
  }
  ASSERT_EQ(task.estimate().driver, DriverState::kHandsOff);
  for (int k = 0; k < 10; ++k) task.idle();
  ASSERT_TRUE(task.fault());
  EXPECT_EQ(task.estimate().driver, DriverState::kUnknown);
}

}  // namespace
}  // namespace steerid
