// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/prior.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace steerid::gap {
namespace {

TEST(Prior, CostsNothingWhereItIsLikeliestAndByItsLawElsewhere) {
  EXPECT_EQ(Prior{}.cost(3), 0);
  EXPECT_EQ(Prior::normal(2, 0).cost(3), 0);  // no deviation: none is known
  EXPECT_DOUBLE_EQ(Prior::normal(2, 0.5).cost(3), 2);
  const Prior given = Prior::of_given(20);
  EXPECT_EQ(given.cost(20), 0);
  EXPECT_NEAR(given.cost(20 * std::exp(0.06)), std::log(2), 1e-12);   // Cauchy's law one width off
  EXPECT_NEAR(given.cost(20 * std::exp(-0.6)), std::log(101), 1e-9);  // and ten
  EXPECT_FALSE(Prior::of_given(0));  // a simulation without a spring says nothing of one
}

TEST(Prior, SlopesAreThoseOfTheCost) {
  for (const Prior& prior : {Prior::normal(2, 0.5), Prior::of_given(2)}) {
    for (const double x : {0.3, 1.7, 2.0, 2.1, 4.0}) {
      constexpr double kStep = 1e-6;
      const double expected = (prior.cost(x + kStep) - prior.cost(x - kStep)) / (2 * kStep);
      EXPECT_NEAR(prior.slope(x), expected, 1e-4 * (1 + std::abs(expected))) << x;
    }
  }
}

/// A step by slope and weight never costs more than to stay: the parabola touches the cost from above.
TEST(Prior, AStepByItsWeightGoesDownhill) {
  const Prior given = Prior::of_given(2);
  for (const double x : {0.5, 1.0, 1.9, 2.05, 2.4, 3.0}) {
    EXPECT_GT(given.weight(x), 0);
    EXPECT_LT(given.cost(x - given.slope(x) / given.weight(x)), given.cost(x)) << x;
  }
  // A number that is nothing is pulled away from it, and by no step that leaves what doubles can hold.
  EXPECT_LT(given.slope(0), 0);
  EXPECT_TRUE(std::isfinite(given.slope(0) / given.weight(0)));
}

}  // namespace
}  // namespace steerid::gap
