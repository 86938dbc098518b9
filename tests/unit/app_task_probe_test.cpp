// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe that the task sizes, in the loop with a driver on a column that is integrated here (steered_column.hpp):
// what it costs, what it reaches, and what becomes of it when the EPS delivers it late, smaller or clipped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <random>

#include "app/task.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "support/seed.hpp"
#include "support/steered_column.hpp"

namespace steerid {
namespace {

/// What an EPS makes of the torque that it is asked for.
struct Delivery {
  std::size_t late_ticks = 0;
  double gain = 1;
  double most_nm = 10;
};

/// What one drive says of its second half, but for `reached_s`.
struct Driven {
  double size_nm = 0;            ///< rms of what was asked for, of the whole drive
  double reached_s = -1;         ///< until J, B and C have deviations of less than a tenth, or -1
  double valid_percent[3] = {};  ///< of the ticks: valid and within 15 %
  double worst_error = 0;        ///< of J, B and C at the end, in deviations
  Estimate last;
};

/// Asks what the task asks, from the next tick on.
template <class Scalar>
class TasksProbe {
 public:
  TasksProbe(IdentificationTask<Scalar>& task, const Delivery& delivery, const test::SteeredColumn& column,
             Driven& driven)
      : task_(&task), delivery_(delivery), arm_{column.inertia_kgm2, column.damping_nms_per_rad, 0}, driven_(&driven) {}

  [[nodiscard]] double asked(double /*t*/) const { return asked_nm_; }
  double delivered(double /*t*/) {
    past_.push_front(asked_nm_);
    const double late = past_.size() > delivery_.late_ticks ? past_[delivery_.late_ticks] : 0;
    return std::clamp(delivery_.gain * late, -delivery_.most_nm, delivery_.most_nm);
  }
  void see(const test::ColumnRow& row) {
    task_->take(test::sample_of(row, tick_++));
    asked_nm_ = 1e-3 * task_->probe_torque_mnm();
    square_ += asked_nm_ * asked_nm_;
    arm_[2] = row.stiffness_nm_per_rad;
    driven_->last = task_->estimate();
    const ParameterEstimate* said[3] = {&driven_->last.inertia, &driven_->last.damping, &driven_->last.stiffness};
    bool reached = tick_ > 300;
    driven_->worst_error = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      reached = reached && said[i]->sd_micro < said[i]->value_micro / 10;
      const double error = 1e-6 * said[i]->value_micro - arm_[i];
      driven_->worst_error = std::max(driven_->worst_error, std::abs(error) / (1e-6 * said[i]->sd_micro));
      if (tick_ > kFrom && said[i]->state == ParameterState::kValid && std::abs(error) < 0.15 * arm_[i]) ++close_[i];
    }
    if (reached && driven_->reached_s < 0) driven_->reached_s = 0.01 * static_cast<double>(tick_);
    driven_->size_nm = std::sqrt(square_ / static_cast<double>(tick_));
    for (std::size_t i = 0; i < 3 && tick_ > kFrom; ++i)
      driven_->valid_percent[i] = 100.0 * close_[i] / static_cast<double>(tick_ - kFrom);
  }

 private:
  static constexpr std::int64_t kFrom = 3000;
  IdentificationTask<Scalar>* task_;
  Delivery delivery_;
  double arm_[3];
  Driven* driven_;
  std::deque<double> past_;
  double asked_nm_ = 0;
  double square_ = 0;
  int close_[3] = {};
  std::int64_t tick_ = 0;
};

template <class Scalar = float>
Driven drive(const test::SteeredColumn& column, std::uint64_t seed, double duration_s = 60,
             const Delivery& delivery = {}, const ProbeLimits& limits = Probe::kGentle) {
  std::mt19937_64 random(seed);
  IdentificationTask<Scalar> task(kSteeringWheel<Scalar>, InputSupervision::kSteeringWheel, limits);
  task.permit_probe(true);
  Driven driven;
  test::drive_with(column, duration_s, random, [&] { return TasksProbe<Scalar>(task, delivery, column, driven); });
  return driven;
}

const test::SteeredColumn kSteers{.intent_rad = 0.05};

/// J, B and C within four of the published deviations, and each valid and close for most of the second half.
void expect_the_arm(const Driven& driven, double least_percent) {
  EXPECT_LT(driven.worst_error, 4);
  for (const double percent : driven.valid_percent) EXPECT_GT(percent, least_percent);
}

// 300 s with 0.05 rad of steering: 0.40 to 0.42 Nm rms, C valid and close on 97 to 98 % of the ticks; a flat probe of
// 0.45 Nm needs 58 to 71 s for what this one has after 8 to 12.
TEST(TaskSizesItsProbe, ReachesWhatIsAskedWithHalfOfTheLimit) {
  const std::uint64_t seed = test::seed(70);
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Driven driven = drive(kSteers, seed + i);
    EXPECT_GT(driven.reached_s, 3) << i;
    EXPECT_LT(driven.reached_s, 25) << i;
    EXPECT_GT(driven.size_nm, 0.25) << i;
    EXPECT_LT(driven.size_nm, 0.65) << i;
    expect_the_arm(driven, 75);
  }
}

TEST(TaskSizesItsProbe, InFixedPointAsInFloat) {
  const std::uint64_t seed = test::seed(74);
  const Driven by_float = drive(kSteers, seed);
  const Driven by_fixed = drive<Fixed>(kSteers, seed);
  EXPECT_NEAR(by_fixed.size_nm, by_float.size_nm, 0.1 * by_float.size_nm);
  expect_the_arm(by_fixed, 75);
}

// What is asked less is bought with less: of 8 and 16 % the power differs by up to four, the size by up to two.
TEST(TaskSizesItsProbe, AsksForLessWhereLessAccuracyIsAsked) {
  static constexpr ProbeLimits kCoarse{.asked_permille = {160, 160, 160}};
  const std::uint64_t seed = test::seed(75);
  const double fine = drive(kSteers, seed, 90).size_nm;
  const double coarse = drive(kSteers, seed, 90, {}, kCoarse).size_nm;
  EXPECT_LT(coarse, 0.85 * fine);
  EXPECT_GT(coarse, 0.3 * fine);
}

// Three ticks are 30 ms, as late as an EPS on a bus is.
TEST(TaskSizesItsProbe, StaysAnInstrumentHoweverItIsDelivered) {
  const std::uint64_t seed = test::seed(76);
  for (const Delivery& delivery : {Delivery{.late_ticks = 1}, Delivery{.late_ticks = 3}, Delivery{.gain = 0.5},
                                   Delivery{.most_nm = 0.8}, Delivery{.late_ticks = 2, .gain = 0.7, .most_nm = 0.9}}) {
    for (std::uint64_t i = 0; i < 3; ++i) {
      SCOPED_TRACE(testing::Message() << delivery.late_ticks << " late, gain " << delivery.gain << ", most "
                                      << delivery.most_nm << ", drive " << i);
      expect_the_arm(drive(kSteers, seed + i, 60, delivery), 50);
    }
  }
}

// Half delivered shows half as much: it asks for more.
TEST(TaskSizesItsProbe, AsksForMoreOfAnEpsThatDeliversLess) {
  const std::uint64_t seed = test::seed(79);
  const double whole = drive(kSteers, seed, 90).size_nm;
  const double half = drive(kSteers, seed, 90, {.gain = 0.5}).size_nm;
  EXPECT_GT(half, 1.4 * whole);
  EXPECT_LT(half, 2.4 * whole);
}

// Nobody feels it there, and it tells when the hands come back: it need not go, but a wheel has no C to look for, and a
// share of nothing would be asked for with all that the limit allows (1 Nm; 0.40 Nm were measured).
TEST(TaskSizesItsProbe, DoesNotGrowOnAWheelThatNobodyHolds) {
  test::SteeredColumn column = kSteers;
  column.let_go_from_s = 30;
  column.let_go_for_s = 60;
  const std::uint64_t seed = test::seed(80);
  const double held_nm = drive(column, seed, 30).size_nm;
  const double all_nm = drive(column, seed, 90).size_nm;
  const double without_nm = std::sqrt((90 * all_nm * all_nm - 30 * held_nm * held_nm) / 60);
  EXPECT_LT(without_nm, 0.7);
}

// A wheel that nothing moves: what size is needed is not known then, and at its limit nothing comes of it.
TEST(TaskSizesItsProbe, RestsOnAWheelThatItDoesNotMove) {
  IdentificationTask<float> task;
  task.permit_probe(true);
  Sample sample;
  sample.valid_bits = kAngleValid | kTorqueBarValid;
  std::int32_t largest_mnm = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    sample.stamp_us = tick * kTickPeriodUs;
    sample.sequence = static_cast<std::uint16_t>(tick);
    task.take(sample);
    largest_mnm = std::max(largest_mnm, task.probe().size_mnm());
    static_cast<void>(task.probe_torque_mnm());
  }
  EXPECT_NEAR(largest_mnm, Probe::kGentle.rms_mnm, 2);
  EXPECT_EQ(task.probe().size_mnm(), 0);
  EXPECT_EQ(task.identifier().follower().probe_needed_nm(Vector3<float>(0.01F, 0.1F, 1)), 0);
}

}  // namespace
}  // namespace steerid
