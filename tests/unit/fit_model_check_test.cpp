// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The alternatives to a linear wheel: found where the plant has them, at their size, and quiet where it has none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "fit/model_check.hpp"
#include "log/resample.hpp"
#include "plant/linear_response.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr WheelArm kArm{0.11, 1.5, 22.7};
constexpr double kNoise_rad = 2e-4;

/// 60 s of eleven sines on a wheel, by Runge and Kutta's method of fourth order with steps of 1 ms: no code of the
/// project's plant. `push` is the effect's own torque; the angle is read `late_s` late,
/// and later by `later_per_s` every second.
template <class Push>
Record driven(Push push, double late_s, double torque_noise_nm, unsigned seed, int every_ms = 10,
              double later_per_s = 0) {
  const auto torque = [](double t) {
    double sum = 0;
    for (int k = 0; k < 11; ++k) sum += 0.5 * std::cos(2 * M_PI * (0.2 + 0.4 * k) * t + 1.7 * k * k);
    return sum;
  };
  const auto rate_of = [&](double t, double angle, double rate) {
    return (torque(t) + push(angle, rate) - kArm.damping_nms_per_rad * rate - kArm.stiffness_nm_per_rad * angle) /
           kArm.inertia_kgm2;
  };
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Record record;
  std::vector<double> angles;
  double angle = 0;
  double rate = 0;
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 60'000; ++i) {
    const double t = i * kStep;
    angles.push_back(angle);
    const double a1 = rate_of(t, angle, rate);
    const double a2 = rate_of(t + kStep / 2, angle + kStep / 2 * rate, rate + kStep / 2 * a1);
    const double a3 = rate_of(t + kStep / 2, angle + kStep / 2 * (rate + kStep / 2 * a1), rate + kStep / 2 * a2);
    const double a4 = rate_of(t + kStep, angle + kStep * (rate + kStep / 2 * a2), rate + kStep * a3);
    angle += kStep * (rate + kStep / 6 * (a1 + a2 + a3));
    rate += kStep / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (i % every_ms != 0 || t < 1) continue;
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(torque(t) + torque_noise_nm * normal(random));
    record.torque_motor_nm.push_back(0);
    const double steps_late = (late_s + later_per_s * t) / kStep;
    const auto late = static_cast<std::size_t>(steps_late);
    const double between = steps_late - static_cast<double>(late);
    const double at = angles[angles.size() - 1 - late];
    const double before = angles[angles.size() - 2 - late];
    record.angle_rad.push_back(at + between * (before - at) + kNoise_rad * normal(random));
  }
  return record;
}

ModelCheck checked(const Record& log) {
  const Resampled resampled = resample_100hz(log);
  return check_model(resampled, fit_batch(resampled.record));
}

const Alternative& likeliest(const ModelCheck& check) { return check.alternatives.at(0); }

constexpr auto kNoPush = [](double, double) { return 0.0; };

TEST(ModelCheck, ALinearWheelIsLeftAlone) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const ModelCheck check = checked(driven(kNoPush, 0, 0.01, seed));
    ASSERT_LE(check.alternatives.size(), 6U);
    ASSERT_GE(check.alternatives.size(), 4U);  // all but friction and damping may have either sign
    EXPECT_TRUE(std::ranges::none_of(check.alternatives, &Alternative::matters)) << seed;
    EXPECT_TRUE(std::ranges::none_of(check.alternatives, &Alternative::shifts)) << seed;
  }
}

// Noise of a tenth of the torque itself: it moves J and C, and would pass for a delay.
TEST(ModelCheck, NoiseOnTheTorqueIsNoAlternative) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const ModelCheck check = checked(driven(kNoPush, 0, 0.15, seed));
    EXPECT_TRUE(std::ranges::none_of(check.alternatives, &Alternative::shifts)) << seed;
  }
}

TEST(ModelCheck, ALateAngleIsFoundAndPutsTheParametersBack) {
  const ModelCheck check = checked(driven(kNoPush, 0.02, 0.01, 1));
  EXPECT_EQ(likeliest(check).kind, Alternative::Kind::kDelay);
  EXPECT_TRUE(likeliest(check).matters);
  EXPECT_NEAR(likeliest(check).size, 0.02, 0.008);  // to first order
}

// Two loggers' clocks, begun together and 30 ms apart; a delay alone explains half of that.
TEST(ModelCheck, ClocksThatDriftApartAreFoundAndPutTheParametersBack) {
  const ModelCheck check = checked(driven(kNoPush, 0, 0.01, 1, 10, 2e-4));
  EXPECT_EQ(likeliest(check).kind, Alternative::Kind::kClockDrift);
  EXPECT_TRUE(likeliest(check).shifts);
  EXPECT_NEAR(likeliest(check).size, 2e-4, 4e-5);  // to first order
  EXPECT_NEAR(likeliest(check).value[0], kArm.inertia_kgm2, 0.03 * kArm.inertia_kgm2);
  // A constant delay is not one that grows.
  EXPECT_EQ(likeliest(checked(driven(kNoPush, 0.006, 0.01, 1))).kind, Alternative::Kind::kDelay);
}

// An angle that is 2 ms late moves B by 2 % of C's share: less than what makes a value wrong, far more than its
// deviation.
TEST(ModelCheck, ASmallDelayShiftsAndDoesNotMatter) {
  const ModelCheck check = checked(driven(kNoPush, 0.002, 0.01, 1));
  EXPECT_EQ(likeliest(check).kind, Alternative::Kind::kDelay);
  EXPECT_TRUE(likeliest(check).shifts);
  EXPECT_FALSE(likeliest(check).matters);
  EXPECT_NEAR(likeliest(check).size, 0.002, 0.0005);
}

TEST(ModelCheck, DryFrictionIsFoundAtEveryRate) {
  for (const int every_ms : {20, 10, 5, 2, 1}) {
    SCOPED_TRACE(every_ms);
    const ModelCheck check =
        checked(driven([](double, double rate) { return -0.3 * std::tanh(rate / 1e-3); }, 0, 0.01, 2, every_ms));
    EXPECT_EQ(likeliest(check).kind, Alternative::Kind::kDryFriction);
    EXPECT_TRUE(likeliest(check).matters);
    EXPECT_NEAR(likeliest(check).size, 0.3, 0.12);
  }
}

TEST(ModelCheck, ACubicSpringIsFound) {
  const ModelCheck check =
      checked(driven([](double angle, double) { return -400 * angle * angle * angle; }, 0, 0.01, 3));
  EXPECT_EQ(likeliest(check).kind, Alternative::Kind::kCubicSpring);
  EXPECT_GT(likeliest(check).size, 0);
}

// A third stiffer to the left than to the right.
TEST(ModelCheck, AsymmetricStiffnessIsFound) {
  const ModelCheck check = checked(
      driven([](double angle, double) { return -0.15 * kArm.stiffness_nm_per_rad * std::abs(angle); }, 0, 0.01, 6));
  EXPECT_EQ(likeliest(check).kind, Alternative::Kind::kAsymmetricStiffness);
  EXPECT_GT(likeliest(check).size, 0);
  EXPECT_GT(likeliest(check).evidence_nats, 100);
}

// Fourth differences of white noise have 70 times its variance; eleven sines up to 4.2 Hz hardly show in them.
TEST(ModelCheck, ReadsTheTorquesNoise) {
  EXPECT_NEAR(checked(driven(kNoPush, 0, 0.02, 4)).torque_noise_nm, 0.02, 0.001);
}

// A log of 50 Hz holds noise up to 25 Hz, and none of more than 50 Hz comes through the filter of a faster one. What
// whitens the fit makes more of a trial noise beyond that than of anything in the record: the bias of a log of 50 Hz
// was 630 times the deviation of J's fit.
TEST(ModelCheck, OfALogOfAnotherRateTheNoiseEndsWhereTheLogsDoes) {
  for (const int every_ms : {20, 15, 5, 2}) {
    SCOPED_TRACE(every_ms);
    const Resampled resampled = resample_100hz(driven(kNoPush, 0, 0.02, 5, every_ms));
    const BatchFit fit = fit_batch(resampled.record);
    const ModelCheck check = check_model(resampled, fit);
    EXPECT_NEAR(check.torque_noise_nm, 0.02, 0.003);
    EXPECT_LT(std::abs(check.torque_noise_bias[0]), fit.inertia.sd);
    EXPECT_LT(std::abs(check.torque_noise_bias[2]), fit.stiffness.sd);
  }
}

}  // namespace
}  // namespace steerid
