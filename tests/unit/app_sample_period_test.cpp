// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Samples that are not 10 ms apart: the period that their stamps tell, and J, B and C of a wheel in steady state, whose
// motion is known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "app/sample_period.hpp"
#include "app/task.hpp"
#include "identifier/fixed_in_eigen.hpp"
#include "support/seed.hpp"
#include "support/steady_wheel.hpp"

namespace steerid {
namespace {

TEST(SamplePeriod, IsTheNominalOneWithinAPercentWhateverTheJitter) {
  std::mt19937_64 random(test::seed(21));
  std::uniform_int_distribution<int> jitter_us(-2000, 2000);
  for (const int period_us : {9930, 9999, 10000, 10001, 10070}) {
    SamplePeriod period;
    int before_us = 0;
    for (int k = 1; k < 100'000; ++k) {
      const int now_us = k * period_us + jitter_us(random);
      ASSERT_FALSE(period.take(now_us - before_us, 1)) << period_us;
      before_us = now_us;
    }
    EXPECT_EQ(period.period_us(), 10'000);
    EXPECT_EQ(period.in_seconds(0.1, 2), 0.1);
  }
}

// Stamps of a whole period's jitter, of which those less than half a period after the last are turned down: no rate.
TEST(SamplePeriod, IsNotTakenFromStampsWithoutOne) {
  std::mt19937_64 random(test::seed(26));
  std::uniform_int_distribution<int> jitter_us(0, 9999);
  SamplePeriod period;
  int before_us = 0;
  for (int k = 1; k < 100'000; ++k) {
    const int elapsed_us = k * 10'000 + jitter_us(random) - before_us;
    if (elapsed_us < 5000) continue;
    ASSERT_FALSE(period.take(elapsed_us, (elapsed_us + 5000) / 10'000));
    before_us += elapsed_us;
  }
}

/// A timer whose periods vary: of 2 ms the mean of a block has a deviation of 0.1 ms, a percent.
TEST(SamplePeriod, StaysTheNominalOneOfPeriodsThatVary) {
  std::mt19937_64 random(test::seed(27));
  std::uniform_int_distribution<int> jitter_us(-2000, 2000);
  SamplePeriod period;
  for (int k = 1; k < 100'000; ++k) ASSERT_FALSE(period.take(10'000 + jitter_us(random), 1)) << k;
}

/// Of samples 5 ms apart and a little less those are left out that are too near: 5 and 10 ms are left.
TEST(SamplePeriod, IsThatOfTheSamplesThatAreTaken) {
  std::mt19937_64 random(test::seed(28));
  std::uniform_int_distribution<int> jitter_us(-20, 20);
  SamplePeriod period;
  std::int64_t elapsed_us = 0;
  std::int64_t all_us = 0;
  std::int64_t samples = 0;
  for (int k = 1; k < 10'000; ++k) {
    elapsed_us += 5000 + jitter_us(random);
    if (elapsed_us < 5000) continue;
    static_cast<void>(period.take(elapsed_us, 1));
    all_us += elapsed_us;
    ++samples;
    elapsed_us = 0;
  }
  EXPECT_NEAR(period.period_us(), static_cast<double>(all_us) / static_cast<double>(samples), 700);
  EXPECT_LT(period.period_us(), 8000);
}

TEST(SamplePeriod, IsFoundAfterTwoBlocksAndNotByOne) {
  for (const int period_us : {6000, 7500, 11'000, 12'000, 14'000}) {
    SamplePeriod period;
    int samples = 1;
    while (!period.take(period_us, 1)) ++samples;
    EXPECT_EQ(samples, 256);
    EXPECT_EQ(period.period_us(), period_us);
    EXPECT_DOUBLE_EQ(period.in_seconds(1.0, 1), 1e-4 * period_us);
    EXPECT_DOUBLE_EQ(period.in_seconds(1.0, 2), 1e-8 * period_us * period_us);
    EXPECT_EQ(period.in_seconds(1.0, 0), 1);
    // One block of something else is a disturbance, and a gap begins a block anew.
    for (int k = 0; k < 128; ++k) EXPECT_FALSE(period.take(10'000, 1));
    for (int k = 0; k < 127; ++k) EXPECT_FALSE(period.take(10'000, 1));
    period.break_here();
    for (int k = 0; k < 128; ++k) EXPECT_FALSE(period.take(period_us, 1));
    EXPECT_EQ(period.period_us(), period_us);
  }
}

/// The wheel with a production wheel's noise, every sample `period_us` after the last, for `seconds`.
template <class Scalar>
void drive(IdentificationTask<Scalar>& task, int period_us, double seconds, std::int64_t& stamp_us,
           std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  test::SteadyWheel wheel;
  wheel.tones = test::SteadyWheel::probe();
  const std::int64_t end_us = stamp_us + std::llround(1e6 * seconds);
  while (stamp_us < end_us) {
    stamp_us += period_us;
    const double t_s = 1e-6 * static_cast<double>(stamp_us);
    Sample sample;
    sample.stamp_us = stamp_us;
    sample.angle_urad = static_cast<std::int32_t>(std::lround(1e6 * wheel.angle_rad(t_s) + 700 * normal(random)));
    sample.torque_driver_mnm = static_cast<std::int32_t>(std::lround(1e3 * wheel.torque_nm(t_s) + 30 * normal(random)));
    task.take(sample);
  }
}

// At 10 ms they are within 1 % after 20 s. A sample that is 14 ms long leaves 0.7 times as many of them, and its
// filters are 0.7 times as fast: 3 % is more than any of it costs, and less than 1 % of the period would.
template <class Scalar>
void expect_right(int period_us) {
  IdentificationTask<Scalar> task;
  std::int64_t stamp_us = 0;
  drive(task, period_us, 20, stamp_us, test::seed(22));
  const Estimate estimate = task.estimate();
  EXPECT_TRUE(task.valid()) << period_us;
  EXPECT_NEAR(1e-6 * estimate.inertia.value_micro / 0.11, 1, 0.03) << period_us;
  EXPECT_NEAR(1e-6 * estimate.damping.value_micro / 1.5, 1, 0.03) << period_us;
  EXPECT_NEAR(1e-6 * estimate.stiffness.value_micro / 22.7, 1, 0.03) << period_us;
  EXPECT_LT(estimate.inertia.sd_micro, 0.05 * estimate.inertia.value_micro);
}

TEST(TaskAtAnotherRate, FindsTheSameArm) {
  for (const int period_us : {6000, 7500, 9500, 10'000, 11'000, 12'000, 14'000}) expect_right<float>(period_us);
}

TEST(TaskAtAnotherRate, FindsTheSameArmInFixedPoint) {
  for (const int period_us : {6000, 14'000}) expect_right<Fixed>(period_us);
}

TEST(TaskAtAnotherRate, SavesAndForgetsInTheUnitsOfThePort) {
  IdentificationTask<float> task;
  std::int64_t stamp_us = 0;
  drive(task, 12'000, 20, stamp_us, test::seed(23));
  SavedEstimate saved;
  ASSERT_EQ(task.save(saved), Status::kOk);
  EXPECT_NEAR(1e-6 * saved.value_micro[0] / 0.11, 1, 0.03);
  // The clock changes: what was learned is forgotten within three seconds, and found anew.
  drive(task, 8000, 3, stamp_us, test::seed(24));
  EXPECT_FALSE(task.valid());
  drive(task, 8000, 20, stamp_us, test::seed(25));
  EXPECT_TRUE(task.valid());
  EXPECT_NEAR(1e-6 * task.estimate().inertia.value_micro / 0.11, 1, 0.03);
}

}  // namespace
}  // namespace steerid
