// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The 100 Hz task: units, bridged and long gaps, faults, and the estimate over power-off.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "app/task.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "support/seed.hpp"
#include "support/steady_wheel.hpp"

namespace steerid {
namespace {

const test::SteadyWheel kWheel{0.11, 1.5, 22.7, test::SteadyWheel::probe()};

/// The wheel's samples as the port delivers them, the torque shared between driver and motor.
class Samples {
 public:
  explicit Samples(std::uint64_t seed, const test::SteadyWheel& wheel = kWheel) : wheel_(wheel), random_(seed) {}
  Sample next() {
    const double t_s = 0.01 * static_cast<double>(tick_);
    const double torque = wheel_.torque_nm(t_s);
    Sample sample;
    sample.stamp_us = tick_++ * kTickPeriodUs;
    sample.angle_urad = integer(wheel_.angle_rad(t_s) * 1e6 + 700 * normal_(random_));
    sample.torque_driver_mnm = integer(0.4 * torque * 1e3 + 30 * normal_(random_));
    sample.torque_motor_mnm = integer(-0.6 * torque * 1e3 + 9 * normal_(random_));
    return sample;
  }

 private:
  static std::int32_t integer(double x) { return static_cast<std::int32_t>(std::lround(x)); }
  test::SteadyWheel wheel_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::int64_t tick_ = 0;
};

template <class Scalar>
void drive(IdentificationTask<Scalar>& task, Samples& samples, int ticks) {
  for (int k = 0; k < ticks; ++k) task.take(samples.next());
}

void expect_the_wheel(const Estimate& estimate, double tolerance) {
  EXPECT_NEAR(estimate.inertia.value_micro / 0.11e6, 1.0, tolerance);
  EXPECT_NEAR(estimate.damping.value_micro / 1.5e6, 1.0, tolerance);
  EXPECT_NEAR(estimate.stiffness.value_micro / 22.7e6, 1.0, tolerance);
}

TEST(Task, PublishesMicroUnitsOfTheWheel) {
  IdentificationTask<float> task;
  Samples samples(test::seed(30));
  drive(task, samples, 6000);
  EXPECT_TRUE(task.valid());
  EXPECT_FALSE(task.fault());
  expect_the_wheel(task.estimate(), 0.01);
  EXPECT_EQ(task.estimate().stamp_us, 5999 * kTickPeriodUs);
  EXPECT_EQ(task.estimate().inertia.state, ParameterState::kValid);
}

TEST(Task, BridgesShortGapsWithoutLearningFromThem) {
  IdentificationTask<float> task;
  Samples samples(test::seed(31));
  drive(task, samples, 3000);
  for (int gap = 0; gap < 300; ++gap) {
    for (int k = 0; k < 1 + gap % 3; ++k) static_cast<void>(samples.next()), task.idle();
    drive(task, samples, 10);
  }
  EXPECT_EQ(task.estimate().counters.accepted_after_gap, 300);
  EXPECT_TRUE(task.valid());
  expect_the_wheel(task.estimate(), 0.02);
}

TEST(Task, ResettlesAfterALongGapAndKeepsWhatItKnew) {
  IdentificationTask<float> task;
  Samples samples(test::seed(32));
  drive(task, samples, 3000);
  for (int gap = 0; gap < 20; ++gap) {
    for (int k = 0; k < 137; ++k) static_cast<void>(samples.next()), task.idle();
    EXPECT_TRUE(task.fault());
    drive(task, samples, 200);
    EXPECT_FALSE(task.fault());
    EXPECT_TRUE(task.valid());
    expect_the_wheel(task.estimate(), 0.02);
  }
}

TEST(Task, AFaultShowsInEveryStateWhileTheValuesStay) {
  IdentificationTask<float> task;
  Samples samples(test::seed(33));
  drive(task, samples, 3000);
  const Estimate before = task.estimate();
  for (int k = 0; k < 10; ++k) {
    Sample sample = samples.next();
    sample.valid_bits = 0;
    task.take(sample);
  }
  const Estimate faulty = task.estimate();
  EXPECT_TRUE(task.fault());
  EXPECT_FALSE(task.valid());
  for (const ParameterEstimate* p : {&faulty.inertia, &faulty.damping, &faulty.stiffness}) {
    EXPECT_EQ(p->state, ParameterState::kFault);
  }
  EXPECT_EQ(faulty.inertia.value_micro, before.inertia.value_micro);
  EXPECT_EQ(faulty.stiffness.sd_micro, before.stiffness.sd_micro);
  EXPECT_EQ(faulty.stamp_us, before.stamp_us);
}

/// A tick of a fault, given the sample that would have come.
using FaultyTick = void (*)(IdentificationTask<float>& task, Sample sample);

/// What is told of the driver for a second after a fault of half a second, tick by tick.
std::vector<DriverState> told_after(FaultyTick faulty) {
  IdentificationTask<float> task;
  Samples samples(test::seed(37));
  drive(task, samples, 3000);
  EXPECT_EQ(task.estimate().driver, DriverState::kBraced);
  for (int k = 0; k < 50; ++k) faulty(task, samples.next());
  EXPECT_TRUE(task.fault());
  EXPECT_EQ(task.estimate().driver, DriverState::kUnknown);
  std::vector<DriverState> told;
  for (int k = 0; k < 100; ++k) {
    task.take(samples.next());
    told.push_back(task.estimate().driver);
  }
  return told;
}

TEST(Task, AFaultOfRefusedSamplesForgetsTheDriverAsOneOfMissingSamplesDoes) {
  const auto missing = told_after([](auto& task, Sample) { task.idle(); });
  EXPECT_EQ(missing.front(), DriverState::kUnknown);  // has to be seen afresh
  EXPECT_EQ(missing.back(), DriverState::kBraced);
  EXPECT_EQ(missing, told_after([](auto& task, Sample sample) {
              sample.valid_bits = 0;
              task.take(sample);
            }));
  EXPECT_EQ(missing, told_after([](auto& task, Sample sample) {
              sample.angle_urad = INT32_MAX;
              task.take(sample);
            }));
  EXPECT_EQ(missing, told_after([](auto& task, Sample sample) {
              sample.stamp_us = task.estimate().stamp_us;
              task.take(sample);
            }));
}

TEST(Task, SavesWhatItHasLearnedAndGoesOnFromIt) {
  IdentificationTask<float> task;
  Samples samples(test::seed(34));
  SavedEstimate saved;
  EXPECT_EQ(task.save(saved), Status::kNoData);
  drive(task, samples, 3000);
  ASSERT_EQ(task.save(saved), Status::kOk);
  EXPECT_EQ(saved.value_micro[0], task.estimate().inertia.value_micro);
  EXPECT_EQ(saved.sd_micro[2], task.estimate().stiffness.sd_micro + 1);
  EXPECT_NEAR(saved.noise_unm, 1e6F * task.identifier().noise_nm(), 1);

  IdentificationTask<float> next;
  ASSERT_EQ(next.restore(saved), Status::kOk);
  const Estimate restored = next.estimate();
  EXPECT_NEAR(restored.inertia.value_micro, saved.value_micro[0], 1);
  EXPECT_EQ(restored.stiffness.state, ParameterState::kHolding);
  EXPECT_FALSE(next.valid());
  SavedEstimate again;
  EXPECT_EQ(next.save(again), Status::kNoData);  // nothing has been shown since

  // No excitation, no valid: fresh data means information, not time.
  Sample rest;
  for (int k = 0; k < 3000; ++k) {
    rest.stamp_us = k * kTickPeriodUs;
    next.take(rest);
    ASSERT_EQ(next.estimate().inertia.state, ParameterState::kHolding);
    ASSERT_FALSE(next.valid());
  }
  IdentificationTask<float> driven;
  ASSERT_EQ(driven.restore(saved), Status::kOk);
  Samples fresh(test::seed(35));
  for (int k = 0; k < 30; ++k) {  // the filters fill
    driven.take(fresh.next());
    ASSERT_FALSE(driven.valid());
  }
  drive(driven, fresh, 1000);
  EXPECT_TRUE(driven.valid());
  expect_the_wheel(driven.estimate(), 0.02);
  EXPECT_EQ(driven.save(again), Status::kOk);
}

TEST(Task, RefusesToGoOnFromNumbersOutsideItsLimits) {
  const SavedEstimate fine{{110'000, 1'500'000, 22'700'000}, {1000, 10'000, 100'000}, 10'000};
  const Estimate untouched = IdentificationTask<float>().estimate();
  const auto refused = [&](auto spoil) {
    SavedEstimate saved = fine;
    spoil(saved);
    IdentificationTask<float> task;
    EXPECT_EQ(task.restore(saved), Status::kOutOfRange);
    EXPECT_EQ(task.estimate().inertia.value_micro, untouched.inertia.value_micro);
    EXPECT_EQ(task.estimate().inertia.state, untouched.inertia.state);
  };
  refused([](SavedEstimate& s) { s.value_micro[0] = 600'001; });
  refused([](SavedEstimate& s) { s.value_micro[1] = 0; });
  refused([](SavedEstimate& s) { s.value_micro[2] = INT32_MIN; });
  refused([](SavedEstimate& s) { s.value_micro[2] = INT32_MAX; });
  refused([](SavedEstimate& s) { s.sd_micro[1] = 0; });
  refused([](SavedEstimate& s) { s.sd_micro[1] = -5; });
  refused([](SavedEstimate& s) { s.noise_unm = 0; });
  IdentificationTask<float> task;
  EXPECT_EQ(task.restore(fine), Status::kOk);
}

/// At a limit an estimate is still one that a save writes, whatever 0.6 is in the type that reads it.
template <class Scalar>
void expect_limits_belong_to_the_range() {
  const SavedEstimate highest{{600'000, 15'000'000, 300'000'000}, {1000, 10'000, 100'000}, 10'000};
  const SavedEstimate lowest{{5'000, 10'000, 10'000}, {1000, 1'000, 1'000}, 10'000};
  for (const SavedEstimate& saved : {highest, lowest}) {
    IdentificationTask<Scalar> task;
    ASSERT_EQ(task.restore(saved), Status::kOk);
    const Estimate on = task.estimate();
    EXPECT_NEAR(on.inertia.value_micro, saved.value_micro[0], 1 + 1e-6 * saved.value_micro[0]);
    EXPECT_NEAR(on.damping.value_micro, saved.value_micro[1], 1 + 1e-6 * saved.value_micro[1]);
    EXPECT_NEAR(on.stiffness.value_micro, saved.value_micro[2], 1 + 1e-6 * saved.value_micro[2]);
  }
  const auto beyond = [&](SavedEstimate saved, std::size_t parameter, std::int32_t by) {
    saved.value_micro[parameter] += by + by * (saved.value_micro[parameter] / 1'000'000);
    IdentificationTask<Scalar> task;
    EXPECT_EQ(task.restore(saved), Status::kOutOfRange) << parameter << " by " << by;
  };
  for (std::size_t parameter = 0; parameter < 3; ++parameter) {
    beyond(highest, parameter, 3);
    beyond(lowest, parameter, -3);
  }
}

TEST(Task, GoesOnFromNumbersAtItsLimits) {
  expect_limits_belong_to_the_range<float>();
  expect_limits_belong_to_the_range<double>();
  expect_limits_belong_to_the_range<Fixed>();
}

}  // namespace
}  // namespace steerid
