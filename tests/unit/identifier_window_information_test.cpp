// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The window's Cramer-Rao bound against a dense inverse in long double.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "identifier/window_information.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using Matrix = std::array<std::array<long double, 3>, 3>;

/// Diagonal of the inverse by cofactors.
std::array<long double, 3> inverse_diagonal(const Matrix& m) {
  const auto minor = [&m](std::size_t a, std::size_t b) { return m[a][a] * m[b][b] - m[a][b] * m[b][a]; };
  const long double det = m[0][0] * minor(1, 2) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                          m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return {minor(1, 2) / det, minor(0, 2) / det, minor(0, 1) / det};
}

TEST(WindowInformation, IsTheInverseOfTheSumOverTheLastBlocks) {
  std::mt19937_64 random(test::seed(11));
  std::normal_distribution<double> normal;
  WindowInformation<double> window;
  Matrix sum{};
  for (int k = 0; k < 3000; ++k) {
    const double shared = normal(random);  // correlation, as real regressors have it
    const Vector3<double> z(20 * normal(random) + 10 * shared, 2 * normal(random), 0.1 * normal(random) - 0.2 * shared);
    window.push(z);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const long double product =
            static_cast<long double>(z(static_cast<int>(i))) * static_cast<long double>(z(static_cast<int>(j)));
        // 3000 samples are 12 blocks: the window holds the last two.
        if (k >= 3000 - 2 * WindowInformation<double>::kBlock) sum[i][j] += product;
      }
    }
  }
  const std::array<long double, 3> expected = inverse_diagonal(sum);
  const Vector3<double> bound = window.bound(1e12);
  for (int i = 0; i < 3; ++i) {
    const auto exact = static_cast<double>(expected[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(bound(i) / exact, 1.0, 1e-9) << i;
  }
}

template <class Scalar>
class WindowInformationOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(WindowInformationOf, Scalars);

TYPED_TEST(WindowInformationOf, NothingIsDark) {
  const WindowInformation<TypeParam> window;
  EXPECT_EQ(window.bound(TypeParam(1e12)), Vector3<TypeParam>::Constant(TypeParam(1e12)));
}

// th = a sin wt: th'' = -w^2 th, so that only C - J w^2 and B w can be seen. The bound of B is that of one regressor
// alone, 1 / (500 (a w)^2 / 2).
TYPED_TEST(WindowInformationOf, ASineLeavesInertiaAndStiffnessInTheDark) {
  WindowInformation<TypeParam> window;
  const double w = 2 * std::numbers::pi * 0.25;
  for (int k = 0; k < 20000; ++k) {
    const double at = w * 0.01 * k;
    window.push({TypeParam(-w * w * std::sin(at)), TypeParam(w * std::cos(at)), TypeParam(std::sin(at))});
  }
  const Vector3<TypeParam> bound = window.bound(TypeParam(1e12));
  EXPECT_GT(bound(kInertia), TypeParam(1e11));
  EXPECT_GT(bound(kStiffness), TypeParam(1e11));
  // The window of 5 s holds one period and a quarter of the 4 s sine, so its mean square wobbles around one half.
  EXPECT_NEAR(bound(kDamping) * TypeParam(500 * w * w / 2), TypeParam(1), TypeParam(0.2));
}

// Over the block before and what there is of this one.
TEST(WindowInformation, HoldsSquaresAgainstThoseOfTheMotion) {
  WindowInformation<double> window;
  EXPECT_EQ(window.over_the_motion(1, 1, 1e-9), 0);
  for (int k = 0; k < 300; ++k) window.push({0.3, 0.2, k < 250 ? 1.0 : 4.0});
  const double angle_power = (250 * 1.0 + 50 * 16.0) / 300;
  EXPECT_NEAR(window.over_the_motion(0.08, 0, 1e-9), 0.5 * 0.08 / 0.04, 1e-12);
  EXPECT_NEAR(window.over_the_motion(0, 7, 1e-9), 0.5 * 7 / angle_power, 1e-12);
  EXPECT_EQ(window.over_the_motion(1, 1, 300 * 0.041), 0);  // the rate's squares are 0.04 each
  WindowInformation<double> without_angle;
  without_angle.push({0, 0.2, 0});
  EXPECT_EQ(without_angle.over_the_motion(1, 1, 1e-9), 0);
}

// Over whole periods the mean squares of a sum of sines add up: of angles 1 and 0.01 at 1 and 10 rad/s the rate's power
// is 1 + 0.01 and the acceleration's 1 + 1. A density of w^-4 has the mean 1.0001 / 2 over the acceleration's power.
TEST(WindowInformation, TellsTheFrequencyThatShowsEachParameter) {
  WindowInformation<double> window;
  EXPECT_EQ(window.frequency_squared(), Vector3<double>::Zero());
  EXPECT_EQ(window.rate_over_angle(), 25);  // what is taken for usual
  WindowInformation<double> without_angle;
  for (int k = 0; k < 60; ++k) without_angle.push({0, 0.2, 0});
  EXPECT_EQ(without_angle.rate_over_angle(), 25);
  const double step =
      2 * std::numbers::pi / WindowInformation<double>::kBlock;  // a block is one period of the slow one
  for (int k = 0; k < 2 * WindowInformation<double>::kBlock; ++k) {
    const double at = step * k;
    EXPECT_EQ(window.rate_over_angle() == 25, k < WindowInformation<double>::kTellsFrequency) << k;
    window.push({-std::sin(at) - std::sin(10 * at), std::cos(at) + 0.1 * std::cos(10 * at),
                 std::sin(at) + 0.01 * std::sin(10 * at)});
  }
  const Vector3<double> found = window.frequency_squared();
  EXPECT_NEAR(found(kStiffness), 1.01 / 1.0001, 1e-9);
  EXPECT_EQ(found(kDamping), found(kStiffness));
  EXPECT_NEAR(window.rate_over_angle(), found(kStiffness), 1e-12);
  EXPECT_NEAR(1 / (found(kInertia) * found(kInertia)), 1.0001 / 2, 1e-9);
}

}  // namespace
}  // namespace steerid
