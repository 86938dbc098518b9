// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whole identifier on a wheel whose motion is known in closed form.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "identifier/identifier.hpp"
#include "support/seed.hpp"
#include "support/steady_wheel.hpp"
#include "support/two_lags.hpp"

namespace steerid {
namespace {

using test::SteadyWheel;
using test::TwoLags;

constexpr double kTorqueNoise = 0.03;   // Nm, a usual torque sensor
constexpr double kAngleNoise = 0.0007;  // rad, a usual encoder with its mounting

/// Feeds seconds of the wheel to any number of identifiers alike.
class Drive {
 public:
  Drive(const SteadyWheel& wheel, std::uint64_t seed, double noise = 1.0)
      : wheel_(wheel), random_(seed), noise_(noise) {}

  template <class Watch, class... Identifiers>
  void run(double seconds, Watch watch, Identifiers&... identifiers) {
    for (const double end = t_ + seconds; t_ < end - 1e-9; t_ = 0.01 * ++tick_) {
      const double torque = wheel_.torque_nm(t_) + noise_ * kTorqueNoise * normal_(random_);
      const double angle = wheel_.angle_rad(t_) + noise_ * kAngleNoise * normal_(random_);
      (feed(identifiers, torque, angle), ...);
      watch();
    }
  }

 private:
  template <class Scalar>
  static void feed(Identifier<Scalar>& identifier, double torque, double angle) {
    identifier.update(static_cast<Scalar>(torque), static_cast<Scalar>(angle));
  }

  SteadyWheel wheel_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double noise_;
  double t_ = 0;
  int tick_ = 0;
};

template <class Scalar>
bool all_valid(const Identifier<Scalar>& identifier) {
  return identifier.belief(0) == Belief::kValid && identifier.belief(1) == Belief::kValid &&
         identifier.belief(2) == Belief::kValid;
}

const auto kIgnore = [] {};

struct Arm {
  double inertia;
  double damping;
  double stiffness;
};

class IdentifierOnAnArm : public ::testing::TestWithParam<Arm> {};

/// Cramer-Rao bound of one standard deviation of J, B, C after `samples` of the wheel's tones, from the phasors: the
/// residual angle - G torque has the spectrum S = s_th^2 + |G|^2 s_u^2, a tone of amplitude a moves by a dG/dp.
Eigen::Vector3d bound_of(const SteadyWheel& wheel, double samples) {
  using Complex = std::complex<double>;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const test::Tone& tone : wheel.tones) {
    const double w = 2 * std::numbers::pi * tone.hz;
    const Complex s(0, w);
    const Complex gain =
        1.0 / (wheel.inertia_kgm2 * s * s + wheel.damping_nms_per_rad * s + wheel.stiffness_nm_per_rad);
    const Eigen::Vector3cd by = -gain * gain * Eigen::Vector3cd(s * s, s, 1.0);
    const double noise = kAngleNoise * kAngleNoise + std::norm(gain) * kTorqueNoise * kTorqueNoise;
    information += samples * tone.amplitude_nm * tone.amplitude_nm / (2 * noise) * (by * by.adjoint()).real();
  }
  return information.inverse().diagonal().cwiseSqrt();
}

TEST_P(IdentifierOnAnArm, FindsInertiaDampingAndStiffness) {
  const auto [inertia, damping, stiffness] = GetParam();
  Identifier<float> identifier;
  const SteadyWheel wheel{inertia, damping, stiffness, SteadyWheel::probe()};
  Drive drive(wheel, test::seed(20));
  drive.run(
      60, [&] { ASSERT_TRUE(identifier.sound()); }, identifier);
  ASSERT_TRUE(all_valid(identifier));
  const Vector3<float> sd = identifier.standard_deviation();
  const Eigen::Vector3d bound = bound_of(wheel, 6000);
  const double truth[] = {inertia, damping, stiffness};
  for (int i = 0; i < 3; ++i) {
    const double error = static_cast<double>(identifier.value()(i)) - truth[i];
    EXPECT_LT(std::abs(error), 4 * bound(i)) << i;
    // Neither vain nor modest. Start, search and early forgetting use up 4 of the 60 s: 1.03 times the bound; the
    // noise's variance is known to sqrt(2/2000) = 3 % and the floor of the memory adds to it.
    EXPECT_GT(static_cast<double>(sd(i)), 0.9 * bound(i)) << i;
    EXPECT_LT(static_cast<double>(sd(i)), 1.3 * bound(i)) << i;
  }
  EXPECT_EQ(identifier.changes(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Arms, IdentifierOnAnArm,
                         ::testing::Values(Arm{0.11, 1.5, 22.7}, Arm{0.11, 2.1, 45.9}, Arm{0.11, 0.7, 17.0}));

// One sine fixes two numbers, C - J w^2 and B w. Whoever prints three valid ones is lying.
TEST(Identifier, OneSineNeverYieldsInertiaAndStiffness) {
  Identifier<float> identifier;
  Drive drive({0.11, 1.5, 22.7, {{0.25, 3.0, 0.0}}}, test::seed(21));
  drive.run(
      300,
      [&] {
        ASSERT_FALSE(all_valid(identifier));
        ASSERT_NE(identifier.belief(kInertia), Belief::kValid);
      },
      identifier);
}

// Variances are relative to the residual's: where the whitening filter takes more out of the motion the residual
// becomes less dense by that, and they must grow; where it gives back some they must shrink. A driver's slow torque
// that no sensor sees comes after 30 s and goes after 60: to the identifier it is one that the sensor misses. A sample
// alone changes a variance by a thousandth.
TEST(Identifier, WeighsAnewWhatItLearnedBehindAnotherWhiteningFilter) {
  Identifier<double> identifier;
  const SteadyWheel wheel{0.11, 1.5, 22.7, SteadyWheel::probe()};
  std::mt19937_64 random(test::seed(31));
  std::normal_distribution<double> normal;
  TwoLags slow_nm(0.15);
  double grown = 1;
  double shrunk = 1;
  for (int k = 0; k < 15000; ++k) {
    const double slow = slow_nm(normal(random) * (k >= 3000 && k < 6000 ? 1 : 0));
    const double torque = wheel.torque_nm(0.01 * k) - slow + kTorqueNoise * normal(random);
    const double angle = wheel.angle_rad(0.01 * k) + kAngleNoise * normal(random);
    const double depth = identifier.colour_depth();
    const double before = identifier.least_of_d();
    const bool learned = all_valid(identifier);
    identifier.update(torque, angle);
    if (!learned) continue;
    const double ratio = identifier.least_of_d() / before;
    if (identifier.colour_depth() > depth) grown *= ratio;
    if (identifier.colour_depth() < depth) shrunk *= ratio;
  }
  EXPECT_GT(grown, 1.01);
  EXPECT_LT(shrunk, 0.99);
}

template <class Scalar>
class IdentifierOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(IdentifierOf, Scalars);

template <class Scalar>
void expect_finite(const Identifier<Scalar>& identifier) {
  ASSERT_TRUE(identifier.sound());
  const Vector3<Scalar> sd = identifier.standard_deviation();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(std::isfinite(identifier.value()(i)));
    ASSERT_TRUE(std::isfinite(sd(i)));
    ASSERT_GE(sd(i), Scalar(0));
  }
}

TYPED_TEST(IdentifierOf, AnHourOfExactlyNothingTeachesNothing) {
  Identifier<TypeParam> identifier;
  for (int k = 0; k < 360'000; ++k) {
    identifier.update(TypeParam(0), TypeParam(0));
    for (int i = 0; i < 3; ++i) ASSERT_NE(identifier.belief(i), Belief::kValid) << "after " << k << " samples";
    if (k % 1000 == 0) expect_finite(identifier);
  }
  const Prior<TypeParam> prior;
  EXPECT_EQ(identifier.value(), Vector3<TypeParam>(prior.value));
}

/// The wheel let go: it swings out by its own differential equation, integrated in steps of 0.1 ms.
template <class Scalar>
void swing_out(Identifier<Scalar>& identifier, double angle, double rate, double inertia, double damping,
               double stiffness, int samples) {
  for (int k = 0; k < samples; ++k) {
    for (int i = 0; i < 100; ++i) {
      rate -= 1e-4 * (damping * rate + stiffness * angle) / inertia;
      angle += 1e-4 * rate;
    }
    if (std::abs(angle) < 1e-9) angle = 0;
    identifier.update(Scalar(0), static_cast<Scalar>(angle));
  }
}

// Hands off, then ten minutes of exactly nothing.
TYPED_TEST(IdentifierOf, ALongPauseKeepsWhatWasLearned) {
  const SteadyWheel wheel{0.11, 1.5, 22.7, SteadyWheel::probe()};
  Identifier<TypeParam> identifier;
  Drive drive(wheel, test::seed(22));
  drive.run(30, kIgnore, identifier);
  const Vector3<TypeParam> before = identifier.value();
  const double rate = (wheel.angle_rad(29.9901) - wheel.angle_rad(29.9899)) / 2e-4;
  swing_out(identifier, wheel.angle_rad(29.99), rate, 0.11, 1.5, 22.7, 60'000);
  expect_finite(identifier);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(identifier.belief(i), Belief::kHolding) << i;
    EXPECT_NEAR(identifier.value()(i) / before(i), TypeParam(1), TypeParam(0.02)) << i;
  }
}

// The bus goes silent in the middle of the motion: everything jumps to zero, which no wheel does, and stays there.
TYPED_TEST(IdentifierOf, ZerosInTheMiddleOfTheMotionDoNoHarmThatLasts) {
  Identifier<TypeParam> identifier;
  Drive drive({0.11, 1.5, 22.7, SteadyWheel::probe()}, test::seed(28));
  drive.run(30, kIgnore, identifier);
  for (int k = 0; k < 60'000; ++k) {
    identifier.update(TypeParam(0), TypeParam(0));
    // What was seen before, and the second in which the model comes to rest, stay in the window of 5 s, and the states
    // are examined every 0.5 s. Until then what is called valid is still right.
    ASSERT_FALSE(k > 650 && all_valid(identifier));
    if (all_valid(identifier)) {
      ASSERT_NEAR(identifier.value()(kStiffness) / TypeParam(22.7), TypeParam(1), TypeParam(0.02));
    }
  }
  expect_finite(identifier);
  drive.run(10, kIgnore, identifier);
  EXPECT_TRUE(all_valid(identifier));
  EXPECT_NEAR(identifier.value()(kStiffness) / TypeParam(22.7), TypeParam(1), TypeParam(0.02));
}

// The change is seen within tenths of a second and searched for in one, the filter rings for half a second, and what
// the wheel's jump from one steady state to the other has left in the search two seconds to be learned away.
// Fifteen percent are asked after a change; how soon, tests/closed_loop/tracking_study_test.cpp holds, where no wheel
// jumps.
TYPED_TEST(IdentifierOf, AnotherArmInMidDriveIsFoundAndKept) {
  Identifier<TypeParam> identifier;
  Drive before(SteadyWheel{0.11, 1.5, 22.7, SteadyWheel::probe()}, test::seed(26));
  before.run(30, kIgnore, identifier);
  ASSERT_TRUE(all_valid(identifier));
  const double truth[] = {0.11, 3.0, 68.1};
  Drive after(SteadyWheel{truth[0], truth[1], truth[2], SteadyWheel::probe()}, test::seed(27));
  const auto farthest = [&] {
    double most = 0;
    for (int i = 0; i < 3; ++i)
      most = std::max(most, std::abs(static_cast<double>(identifier.value(i)) / truth[i] - 1));
    return most;
  };
  EXPECT_GT(farthest(), 0.4);
  after.run(4, kIgnore, identifier);
  EXPECT_EQ(identifier.changes(), 1U);
  after.run(
      10, [&] { EXPECT_LT(farthest(), 0.15); }, identifier);
  EXPECT_EQ(identifier.changes(), 1U);
  EXPECT_LT(farthest(), 0.05);
  EXPECT_TRUE(all_valid(identifier));
}

TYPED_TEST(IdentifierOf, WhatIsNoNumberIsAGap) {
  using Limits = std::numeric_limits<TypeParam>;
  Identifier<TypeParam> identifier;
  Identifier<TypeParam> resettled;
  Drive drive({0.11, 1.5, 22.7, SteadyWheel::probe()}, test::seed(23));
  drive.run(30, kIgnore, identifier, resettled);
  for (const TypeParam bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), Limits::max(),
                              Limits::lowest(), TypeParam(1001)}) {
    identifier.update(bad, TypeParam(0));
    identifier.update(TypeParam(0), bad, false);
    resettled.resettle();
    expect_finite(identifier);
    drive.run(5, kIgnore, identifier, resettled);
    ASSERT_EQ(identifier.value(), resettled.value());
    ASSERT_EQ(identifier.standard_deviation(), resettled.standard_deviation());
    ASSERT_TRUE(all_valid(identifier));
  }
}

TYPED_TEST(IdentifierOf, GoesOnFromARestoredEstimate) {
  Identifier<TypeParam> identifier;
  const Vector3<TypeParam> value(TypeParam(0.11), TypeParam(1.5), TypeParam(22.7));
  const Vector3<TypeParam> sd = value * TypeParam(0.003);
  identifier.restore(value, sd, TypeParam(0.01));
  EXPECT_EQ(identifier.value(), value);
  // Quiet: it holds, for as long as it takes, and claims less than what was saved.
  for (int k = 0; k < 6000; ++k) {
    identifier.update(TypeParam(0), TypeParam(0));
    for (int i = 0; i < 3; ++i) ASSERT_EQ(identifier.belief(i), Belief::kHolding);
  }
  for (int i = 0; i < 3; ++i) EXPECT_GT(identifier.standard_deviation()(i), sd(i)) << i;
  Drive drive({0.11, 1.5, 22.7, SteadyWheel::probe()}, test::seed(24));
  drive.run(20, kIgnore, identifier);
  EXPECT_TRUE(all_valid(identifier));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(identifier.value()(i) / value(i), TypeParam(1), TypeParam(0.01)) << i;
}

TYPED_TEST(IdentifierOf, ARestoredEstimateOfAnotherDriverGivesWay) {
  Identifier<TypeParam> identifier;
  identifier.restore({TypeParam(0.11), TypeParam(0.7), TypeParam(10)},
                     {TypeParam(0.001), TypeParam(0.01), TypeParam(0.1)}, TypeParam(0.01));
  Drive drive({0.11, 2.1, 45.9, SteadyWheel::probe()}, test::seed(25));
  drive.run(20, kIgnore, identifier);
  EXPECT_NEAR(identifier.value()(kDamping) / TypeParam(2.1), TypeParam(1), TypeParam(0.03));
  EXPECT_NEAR(identifier.value()(kStiffness) / TypeParam(45.9), TypeParam(1), TypeParam(0.03));
}

// Both see the same noise, so that what differs is rounding, over an hour. The design asks for 1e-5.
TEST(Identifier, FloatFollowsDoubleForAnHour) {
  Identifier<float> in_float;
  Identifier<double> in_double;
  Drive drive({0.11, 1.5, 22.7, SteadyWheel::probe()}, test::seed(26));
  double worst = 0;
  for (int minute = 0; minute < 60; ++minute) {
    drive.run(60, kIgnore, in_float, in_double);
    for (int i = 0; i < 3; ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(in_float.value()(i)) / in_double.value()(i) - 1));
      ASSERT_EQ(in_float.belief(i), in_double.belief(i));
    }
  }
  std::printf("largest relative difference %.3g\n", worst);
  EXPECT_LT(worst, 1e-5);
}

// The stiffest corner of the limits, where an explicit step of the model would run away.
TEST(Identifier, StaysSoundAtTheStiffestCorner) {
  IdentifierSettings<float> settings;
  settings.prior.value = {settings.prior.lowest(0), settings.prior.lowest(1), settings.prior.highest(2)};
  settings.prior.spread = settings.prior.value * 0.001F;
  Identifier<float> identifier(settings);
  std::mt19937_64 random(test::seed(27));
  std::normal_distribution<float> normal;
  for (int k = 0; k < 20'000; ++k) {
    const float torque = normal(random);
    identifier.update(torque, torque / 300.0F);
    expect_finite(identifier);
  }
}

// A turn of 5 Nm that takes 50 s shows C alone. J and B are held: not a bit of them moves, and they are not valid.
TEST(Identifier, HoldsInertiaAndDampingWhereMotionShowsStiffnessAlone) {
  constexpr test::Tone kTurn{0.02, 5.0, 0.0};
  SteadyWheel wheel{0.11, 1.5, 22.7, SteadyWheel::probe()};
  wheel.tones.push_back(kTurn);
  Identifier<float> identifier;
  Drive probed(wheel, test::seed(98));
  probed.run(20, kIgnore, identifier);
  ASSERT_TRUE(all_valid(identifier));
  wheel.tones = {{kTurn.hz, kTurn.amplitude_nm, 2 * std::numbers::pi * kTurn.hz * 20}};
  Drive turning(wheel, test::seed(99));
  turning.run(10, kIgnore, identifier);  // the probe has left the window of 5 s and the noise's estimate
  const Vector3<float> held = identifier.value();
  turning.run(
      20,
      [&] {
        ASSERT_EQ(identifier.value(kInertia), held(kInertia));
        ASSERT_EQ(identifier.value(kDamping), held(kDamping));
        ASSERT_EQ(identifier.belief(kInertia), Belief::kHolding);
        ASSERT_EQ(identifier.belief(kDamping), Belief::kHolding);
      },
      identifier);
  EXPECT_NE(identifier.value(kStiffness), held(kStiffness));
  EXPECT_EQ(identifier.belief(kStiffness), Belief::kValid);
}

// Tones below 2 Hz on a stiff arm: the torque sensor's noise makes more than an eightieth of what shows J, which is
// held therefore, while the window's bound alone would call it known to a tenth: on 97 % of the ticks. What does not
// learn is not confirmed; 2 % leaves room for the refreshes at which it just does.
TEST(Identifier, DoesNotCallValidWhatItHolds) {
  const std::vector<test::Tone> tones{{0.71, 0.52, 0.0}, {0.32, 1.46, 1.0}, {1.62, 1.4, 2.0}, {1.22, 0.23, 3.0}};
  int ticks = 0;
  std::array<int, 3> valid{};
  const std::uint64_t first = test::seed(97);
  for (std::uint64_t seed = first; seed < first + 10; ++seed) {
    Identifier<float> identifier;
    Drive drive({0.032, 0.15, 29.5, tones}, seed);
    drive.run(10, kIgnore, identifier);
    drive.run(
        20,
        [&] {
          ++ticks;
          for (int i = 0; i < 3; ++i) valid[static_cast<std::size_t>(i)] += identifier.belief(i) == Belief::kValid;
        },
        identifier);
  }
  EXPECT_LT(valid[kInertia], 0.02 * ticks);
  EXPECT_GT(valid[kDamping], 0.9 * ticks);
  EXPECT_GT(valid[kStiffness], 0.9 * ticks);
}

}  // namespace
}  // namespace steerid
