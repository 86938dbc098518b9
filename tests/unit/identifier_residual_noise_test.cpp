// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a deviation may claim by the residual's noise, against closed forms of that noise's spectrum: a first-order
// autoregression with coefficient a.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "identifier/residual_noise.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using Noise = ResidualNoise<double>;
constexpr double kAngleStep = 1e-13;  // rad^2, less than any motion here

/// What is claimed, over the variance that was learned, in the mean over 2000 s of noise by an autoregression, while
/// the wheel turns at 1 Hz.
double claimed_over_variance(double a, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Noise noise;
  WindowInformation<double> window;
  double e = 0;
  double sum = 0;
  int counted = 0;
  for (int k = 0; k < 200'000; ++k) {
    e = a * e + normal(random);
    const double t = 0.01 * k;
    const double w = 2 * std::numbers::pi;
    const Vector3<double> z(-w * w * std::sin(w * t), w * std::cos(w * t), std::sin(w * t));
    window.push(z);
    noise.learn(1, e * e, false);
    noise.score(e, z(kDamping), z(kStiffness));
    if (k % Noise::kEvery != Noise::kEvery - 1) continue;
    noise.learn_from_scores(window, noise.claimed(), kAngleStep);
    if (k < 4'000) continue;
    sum += noise.claimed() / noise.variance();
    ++counted;
  }
  return sum / counted;
}

// Of 3900 refreshes a mean of squares scatters by 1.25 / sqrt(3900), 2 %.
TEST(ResidualNoise, ClaimsTheVarianceOfWhiteNoise) { EXPECT_NEAR(claimed_over_variance(0, test::seed(301)), 1, 0.06); }

// The low pass of pole 0.025 meets, at 1 Hz, which is w = 0.0628 rad a sample, the sum of (0.975 a)^|k| cos(w k) over
// all lags k: 5.16 variances for a = 0.7, where the density itself is 5.5. Half of the variance comes on top of it.
TEST(ResidualNoise, ClaimsTheDensityThatTheMotionMeets) {
  constexpr double kNoise = 0.7;
  const double c = 0.975 * kNoise;
  const double met = (1 - c * c) / (1 - 2 * c * std::cos(0.02 * std::numbers::pi) + c * c);
  EXPECT_NEAR(claimed_over_variance(kNoise, test::seed(302)) / (met + 0.5), 1, 0.05);
}

// The density is a third of the variance there.
TEST(ResidualNoise, ClaimsAShareOfTheVarianceAtLeast) {
  EXPECT_NEAR(claimed_over_variance(-0.5, test::seed(303)), 0.72, 0.02);
}

TEST(ResidualNoise, IsTheMeanOfTheLastTwentySeconds) {
  Noise noise;
  double sum = 0;
  for (int n = 1; n <= 2'000; ++n) {
    sum += n;
    noise.learn(1, n, false);
    ASSERT_NEAR(noise.variance(), sum / n, 1e-9 * sum);
  }
  const double before = noise.variance();
  noise.learn(1, 0, false);
  noise.learn(1, 0, false);
  EXPECT_NEAR(noise.variance() / before, (1 - 1.0 / 2'000) * (1 - 1.0 / 2'000), 1e-12);
}

TEST(ResidualNoise, AWildResidualCountsForNineOfItsVarianceOnceThatIsFirmAndForOneBefore) {
  for (const std::int16_t samples : {std::int16_t{98}, std::int16_t{99}}) {  // the next is one more
    Noise noise;
    noise.assume(1);
    noise.stands_on(samples);
    noise.learn(400, 400, true);
    EXPECT_DOUBLE_EQ(noise.variance(), samples + 1 < Noise::kFirm ? 1 : 1 + 8.0 / (samples + 1)) << samples;
    noise.assume(1);
    noise.learn(400, 401, false);
    EXPECT_DOUBLE_EQ(noise.variance(), 1 + 400.0 / (samples + 2)) << "while parameters come to rest it is let in";
  }
}

TEST(ResidualNoise, WhatIsAssumedIsClaimedAndLastsAsLongAsItIsToldToStandFor) {
  Noise noise;
  noise.assume(0.25);
  EXPECT_DOUBLE_EQ(noise.claimed(), 0.25);
  noise.stands_on(3);
  noise.learn(1, 1.25, false);
  EXPECT_DOUBLE_EQ(noise.variance(), 0.25 + 1.0 / 4);
  noise.stands_on_at_most(1);
  noise.learn(1, 1.5, false);
  EXPECT_DOUBLE_EQ(noise.variance(), 0.5 + 1.0 / 2);
  noise.stands_on_at_most(10);
  noise.learn(1, 4, false);
  EXPECT_DOUBLE_EQ(noise.variance(), 1 + 3.0 / 3);
  noise.begin_anew();
  EXPECT_DOUBLE_EQ(noise.variance(), 2);
  noise.learn(1, 0.5, false);
  EXPECT_DOUBLE_EQ(noise.variance(), 0.5);
  EXPECT_DOUBLE_EQ(noise.claimed(), 0.36) << "before any score";
}

TEST(ResidualNoise, IsNeverLessThanThePortsResolution) {
  Noise noise;
  noise.forget();
  EXPECT_DOUBLE_EQ(noise.variance(), 1e-6);
  for (int k = 0; k < 10; ++k) noise.learn(0, 0, true);
  EXPECT_DOUBLE_EQ(noise.variance(), 1e-6);
}

// One score of 40 that is as large as a fault makes it adds 16 times what is claimed, by its share.
TEST(ResidualNoise, AWildScoreIsBoundedAndNoneIsLearnedFromAtRest) {
  WindowInformation<double> window;
  for (int k = 0; k < 400; ++k) window.push(Vector3<double>(1, 1, 1));
  Noise noise;
  noise.assume(1);
  noise.stands_on(2'000);
  for (int k = 0; k < 400; ++k) noise.score(1e3, 1, 1);
  noise.learn_from_scores(window, noise.claimed(), kAngleStep);
  const double by_scores = 1 + (16 - 1) * 50.0 / 2'000;
  EXPECT_DOUBLE_EQ(noise.claimed(), by_scores + 0.25 * (by_scores - 1));
  noise.learn_from_scores(WindowInformation<double>(), noise.claimed(), kAngleStep);
  EXPECT_DOUBLE_EQ(noise.claimed(), 1);
}

}  // namespace
}  // namespace steerid
