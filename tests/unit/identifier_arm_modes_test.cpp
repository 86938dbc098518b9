// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is at the ends of the identifier by the probe: limits of arms, input that is none, sources that come and go.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identifier/arm_modes.hpp"
#include "identifier/closed_loop_identifier.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

TEST(Exponential, IsThatOfLibmWithinItsBoundAndHeldAtItsEnds) {
  for (double x = 0.01; x <= 16; x += 0.01) {
    // 64 times what the series leaves out, (x/64)^3 / 6 and (x/64)^4 / 24 of which the bracket has none.
    const double bound = 64 * (std::pow(x / 64, 3) / 6 + std::pow(x / 64, 4) / 8) * 1.2 + 1e-12;
    EXPECT_NEAR(exponential_of_minus(x) / std::exp(-x), 1, std::exp(bound) - 1 + 1e-12) << x;
  }
  EXPECT_EQ(exponential_of_minus(-1.0), 1);
  EXPECT_EQ(exponential_of_minus(0.0), 1);
  EXPECT_EQ(exponential_of_minus(20.0), exponential_of_minus(16.0));
}

// Behind a spring of 25 Nm/rad alone the filters are one Kalman filter of C where nothing changes.
TEST(ArmModes, ReachTheDeviationOfTheWalkThatTheyAllow) {
  std::mt19937_64 random(test::seed(2));
  std::normal_distribution<double> normal;
  const ClosedLoopSettings<double> settings;
  ArmModes<double> modes(settings.prior);
  double squares = 0, claimed = 0;
  constexpr int kLooks = 20000, kFrom = 2000;
  for (int k = 0; k < kLooks; ++k) {
    const double angle = 0.05 * normal(random);
    const Vector3<double> z(0, 0, angle);
    modes.look(25 * angle + 0.05 * normal(random), z, z, 0.05 * 0.05);
    if (k < kFrom) continue;
    squares += (modes.value()(kStiffness) - 25) * (modes.value()(kStiffness) - 25);
    claimed += modes.variance()(kStiffness);
  }
  // An arm that never changes is less than what it may do: the claim may be too large, by what the walk allows.
  EXPECT_LT(squares, claimed);
  EXPECT_GT(squares, 0.1 * claimed);
  EXPECT_GT(modes.probability(0), 0.5);
  EXPECT_NEAR(modes.probability(0) + modes.probability(1) + modes.probability(2), 1, 1e-9);
}

TEST(ArmModes, StayInsideTheLimits) {
  const ClosedLoopSettings<double> settings;
  for (const double torque_nm : {1000.0, -1000.0}) {
    ArmModes<double> modes(settings.prior);
    const Vector3<double> z(1, 1, 1);
    for (int k = 0; k < 200; ++k) {
      modes.look(torque_nm, z, z, 1e-4);
      ASSERT_TRUE(modes.sound());
    }
  }
}

// Nothing moves for half an hour.
TEST(ClosedLoopIdentifier, KnowsNothingOfAWheelAtRest) {
  ClosedLoopIdentifier<double> identifier;
  for (int k = 0; k < 140000; ++k) {
    identifier.update(0, 0, 0);
    ASSERT_TRUE(identifier.sound());
  }
  for (int p = 0; p < 3; ++p) EXPECT_EQ(identifier.belief(p), Belief::kNotExcited);
}

// A wheel on a probe alone, stepped here: J = 0.1, B = 1.5, C = 20 driven by the probe alone.
TEST(ClosedLoopIdentifier, KeepsWhatItKnewButNotAsValidWhenTheProbeEndsAndLearnsNothingFromFilledSamples) {
  std::mt19937_64 random(test::seed(3));
  std::normal_distribution<double> normal;
  constexpr double kStep = 0.001;
  double angle = 0, rate = 0, probe = 0;
  ClosedLoopIdentifier<double> identifier;
  const auto tick = [&](double amplitude_nm, bool learn) {
    probe += 0.2 * (amplitude_nm * normal(random) * 3 - probe);
    for (int i = 0; i < 10; ++i) {
      rate += kStep * (probe - 1.5 * rate - 20 * angle) / 0.1;
      angle += kStep * rate;
    }
    identifier.update(probe + 0.01 * normal(random), angle + 2e-4 * normal(random), probe, learn);
  };
  for (int k = 0; k < 9000; ++k) tick(1, true);
  for (int p = 0; p < 3; ++p) EXPECT_EQ(identifier.belief(p), Belief::kValid);
  EXPECT_NEAR(identifier.value(kStiffness), 20, 4 * identifier.standard_deviation()(kStiffness));
  const Vector3<double> before = identifier.value();
  for (int k = 0; k < 500; ++k) tick(1, false);
  EXPECT_EQ(identifier.value(), before);
  identifier.update(0, 0, 1e9);
  identifier.update(0, -1e9, 0);
  for (int k = 0; k < 20000; ++k) tick(0, true);
  for (int p = 0; p < 3; ++p) {
    // At rest the torque sensor's noise may pass for motion: converging, then, and never valid.
    EXPECT_NE(identifier.belief(p), Belief::kValid) << "parameter " << p;
    EXPECT_NE(identifier.belief(p), Belief::kNotExcited) << "parameter " << p;
  }
  EXPECT_FALSE(identifier.by_probe());
}

TEST(ClosedLoopIdentifier, GoesOnFromWhatWasSaved) {
  ClosedLoopIdentifier<double> identifier;
  identifier.restore(Vector3<double>(0.12, 2, 30), Vector3<double>(0.001, 0.01, 0.3));
  EXPECT_NEAR(identifier.value(kStiffness), 30, 1e-12);
  EXPECT_NEAR(identifier.standard_deviation()(kStiffness), 3, 1e-12);
  EXPECT_EQ(identifier.belief(kStiffness), Belief::kHolding);
}

}  // namespace
}  // namespace steerid
