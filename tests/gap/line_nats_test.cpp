// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where in the spectrum a change acts, against sums of log likelihoods of drawn lines.
#include "gap/sets/line_nats.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/seed.hpp"

namespace steerid::gap {
namespace {

SetLines lines_of(Eigen::Index count, double density) {
  SetLines out;
  out.residual = Spectrum::Zero(count);
  out.density = Eigen::ArrayXd::Constant(count, density);
  out.counted = Eigen::ArrayXd::Ones(count);
  return out;
}

/// Against the Bhattacharyya coefficient, the mean of sqrt(q/p) over 200,000 lines drawn from p. The deviation of what
/// follows from it is 0.009 nats.
TEST(LineNats, AreFourTimesTheBhattacharyyaDistance) {
  constexpr double kDensity = 1.0;
  constexpr double kOther = 2.5;
  const Complex apart(0.6, -0.8);
  std::mt19937_64 engine(test::seed(131));
  std::normal_distribution<double> normal(0, std::sqrt(kDensity / 2));
  constexpr int kCount = 200'000;
  double sum = 0;
  for (int i = 0; i < kCount; ++i) {
    const Complex left(normal(engine), normal(engine));
    const double log_ratio =
        std::log(kDensity) + std::norm(left) / kDensity - std::log(kOther) - std::norm(left + apart) / kOther;
    sum += std::exp(log_ratio / 2);
  }
  SetLines with = lines_of(1, kDensity);
  SetLines without = lines_of(1, kOther);
  without.residual[0] = apart;
  EXPECT_NEAR(expected_nats(with, without)[0], -4 * std::log(sum / kCount), 0.04);
  EXPECT_NEAR(expected_nats(with, without)[0], expected_nats(without, with)[0], 1e-12);
  EXPECT_NEAR(expected_nats(with, with)[0], 0, 1e-12);
}

/// Between sets of one density they are the mean of what the log likelihoods differ by: |r0 - r1|^2 / S.
TEST(LineNats, AreWhatTheLogLikelihoodsDifferByInTheMeanWhereTheNoiseIsTheSame) {
  const SetLines with = lines_of(1, 2.5);
  SetLines without = with;
  without.residual[0] = Complex(3, -4);
  EXPECT_NEAR(expected_nats(with, without)[0], 25 / 2.5, 1e-12);
}

/// A set whose wheel hardly damps passes a hundred million times the noise at its resonance. It could explain anything
/// there, which is no reason to expect that the record tells so much.
TEST(LineNats, GrowWithTheLogarithmOfADensityAlone) {
  const SetLines with = lines_of(1, 1e8);
  const SetLines without = lines_of(1, 1);
  EXPECT_LT(expected_nats(with, without)[0], 2 * std::log(1e8));
}

TEST(LineNats, WeighTheLinesOnWhichAChangeActs) {
  Eigen::ArrayXd nats = Eigen::ArrayXd::Zero(100);
  nats.head(4) = 3;
  const Eigen::ArrayXd weights = acting_on(nats);
  EXPECT_NEAR(weights.sum(), 4, 1e-12);
  EXPECT_NEAR(weights[3], 1, 1e-12);
  EXPECT_EQ(weights[4], 0);
  EXPECT_EQ(acting_on(Eigen::ArrayXd::Zero(5)).sum(), 0);
}

/// An effect that makes a half of all on its lines has twice its own nats there, whatever stands on one of them alone.
TEST(LineNats, CountWhatAllChangesExplainWhereOneActs) {
  Eigen::ArrayXd nats = Eigen::ArrayXd::Zero(100);
  nats.head(50) = 2;
  Eigen::ArrayXd all = Eigen::ArrayXd::Constant(100, 4);
  EXPECT_NEAR(nats_beside(nats, all), 200, 1e-9);
  all[0] = 1e9;
  EXPECT_NEAR(nats_beside(nats, all), 200 * 50.0 / 49, 1e-3);
  EXPECT_NEAR(nats_beside(nats, nats), nats.sum(), 1e-9);
  EXPECT_EQ(nats_beside(Eigen::ArrayXd::Zero(3), all.head(3)), 0);
}

/// What is left elsewhere says nothing of the change.
TEST(LineNats, CountWhatIsLeftWhereTheChangeActs) {
  SetLines one = lines_of(100, 2.0);
  one.residual.setConstant(std::sqrt(2.0));  // at the floor
  one.residual[1] = std::sqrt(2.0 * 6);      // 5 nats above it
  one.residual[50] = std::sqrt(2.0 * 101);
  Eigen::ArrayXd weights = Eigen::ArrayXd::Zero(100);
  weights.head(4) = 1;
  EXPECT_NEAR(left_nats_on(weights, one), 5 + std::sqrt(4.0) / 2, 1e-9);
}

}  // namespace
}  // namespace steerid::gap
