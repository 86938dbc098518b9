// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The forgetting rule against what its equations come to: a fixed point, an infinite product, and what it must not
// touch.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identifier/directional_forgetting.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using Vector = Vector3<double>;

const Vector kArm(0.1, 1.5, 20);
constexpr double kFloorSquare = 4e-4;  // 2 % of each, noise of variance 1
const Vector kFloor = kArm * std::sqrt(kFloorSquare);

/// Samples of a motion along `z` drawn of these sizes: each is observed and forgotten.
void drive(UdCovariance<double>& covariance, DirectionalForgetting<double>& rule, const Vector& size, int samples,
           std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (int k = 0; k < samples; ++k) {
    const Vector z(size(0) * normal(random), size(1) * normal(random), size(2) * normal(random));
    (void)covariance.observe(z, 0.0);
    rule.forget(covariance, kArm, z, kFloorSquare, Held::kNone);
  }
}

// With Pd for P the two terms are the same and cancel: it is the only P that stays where everything is excited.
TEST(DirectionalForgetting, ReturnsToItsFloorFromAboveAndFromBelow) {
  for (const double start : {0.3, 30.0}) {
    UdCovariance<double> covariance(kFloor * start);
    DirectionalForgetting<double> rule;
    drive(covariance, rule, Vector(100, 7, 0.5), 40'000, test::seed(91));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::sqrt(covariance.variance()(i)) / kFloor(i), 1, 1e-3) << start << i;
  }
}

TEST(DirectionalForgetting, LeavesAloneWhatIsNotExcited) {
  UdCovariance<double> covariance(kFloor * 30);
  DirectionalForgetting<double> rule;
  drive(covariance, rule, Vector(0, 7, 0.5), 40'000, test::seed(92));
  EXPECT_NEAR(std::sqrt(covariance.variance()(kInertia)) / kFloor(kInertia), 30, 1e-9);
  EXPECT_NEAR(std::sqrt(covariance.variance()(kDamping)) / kFloor(kDamping), 1, 1e-3);
}

// Of (1 + s f^k) over all k the logarithm is s / (1 - f) - s^2 / (2 (1 - f^2)) + s^3 / (3 (1 - f^3)) ...
TEST(DirectionalForgetting, ForgetsAllByAShareThatFades) {
  constexpr double kShare = 0.05;
  const double fade = std::exp(-0.01 / 1.5);
  double logarithm = 0;
  for (int n = 1; n < 12; ++n) {
    logarithm += (n % 2 == 1 ? 1 : -1) * std::pow(kShare, n) / (n * (1 - std::pow(fade, n)));
  }
  UdCovariance<double> covariance(kFloor);
  DirectionalForgetting<double> rule;
  rule.forget_all(kShare);
  for (int k = 0; k < 5'000; ++k) rule.forget(covariance, kArm, Vector::Zero(), kFloorSquare, Held::kNone);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::log(covariance.variance()(i) / (kFloor(i) * kFloor(i))), logarithm, 2e-3 * logarithm) << i;
  }
}

TEST(DirectionalForgetting, EndsWhenItIsToldTo) {
  UdCovariance<double> covariance(kFloor);
  DirectionalForgetting<double> rule;
  rule.forget_all(0.25);
  rule.fade(0);
  rule.forget(covariance, kArm, Vector::Zero(), kFloorSquare, Held::kNone);
  rule.forget_all(0.25);
  rule.forget_all(0);
  rule.forget(covariance, kArm, Vector::Zero(), kFloorSquare, Held::kNone);
  for (int i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(std::sqrt(covariance.variance()(i)), kFloor(i)) << i;
}

TEST(DirectionalForgetting, LeavesAloneWhatIsHeld) {
  const Vector z(100, 7, 0.5);
  for (const Held held : {Held::kInertiaOnly, Held::kInertiaAndDamping, Held::kAll}) {
    UdCovariance<double> covariance(kFloor);
    DirectionalForgetting<double> rule;
    rule.forget_all(0.1);
    rule.forget(covariance, kArm, z, kFloorSquare, held);
    for (int i = 0; i < 3; ++i) {
      const double deviation = std::sqrt(covariance.variance()(i));
      if (holds(held, i)) {
        EXPECT_DOUBLE_EQ(deviation, kFloor(i)) << i;
      } else {
        EXPECT_GT(deviation, kFloor(i) * 1.001) << i;
      }
    }
  }
}

}  // namespace
}  // namespace steerid
