// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Analysis of variance with repeated measures: against a published example and against the paired t test.
#include <gtest/gtest.h>

#include <cmath>

#include "reproduction/repeated_measures.hpp"

namespace steerid {
namespace {

// Field, Discovering Statistics Using SPSS (2009), chapter 13: eight celebrities eat four animals. Squares of the
// animals 83.125 and of the error 153.375, F(3, 21) = 3.79, Greenhouse and Geisser's epsilon .533, p = .063.
TEST(RepeatedMeasures, IsFieldsExample) {
  const std::vector<std::vector<double>> y{{8, 7, 1, 6}, {9, 5, 2, 5}, {6, 2, 3, 8},  {5, 3, 1, 9},
                                           {8, 4, 5, 8}, {7, 5, 6, 7}, {10, 2, 7, 2}, {12, 6, 8, 1}};
  const RepeatedMeasures found = repeated_measures(y);
  ASSERT_TRUE(found.tested());
  EXPECT_EQ(found.between(), 3);
  EXPECT_EQ(found.within(), 21);
  EXPECT_NEAR(found.f, (83.125 / 3) / (153.375 / 21), 1e-9);
  EXPECT_NEAR(found.epsilon, 0.533, 5e-4);
  EXPECT_NEAR(found.p, 0.063, 5e-4);
  EXPECT_NEAR(found.partial_eta_squared, 83.125 / (83.125 + 153.375), 1e-9);
  EXPECT_NEAR(found.level_mean[0], 8.125, 1e-12);
}

// Two levels are a paired t test: differences 1.1, .9, 1.0, 1.2, .8 have mean 1 and standard deviation sqrt(.025), so
// t^2 = 5/.025 = 200, however far the subjects lie apart. Student's t with 4 degrees of freedom has a closed form:
// with c = t/sqrt(4 + t^2) the two-sided p is 1 - c (3 - c^2)/2.
TEST(RepeatedMeasures, OfTwoLevelsIsThePairedTTest) {
  std::vector<std::vector<double>> y;
  for (const double difference : {1.1, 0.9, 1.0, 1.2, 0.8}) {
    const auto subject = static_cast<double>(y.size());
    y.push_back({100 * subject * subject, 100 * subject * subject + difference});
  }
  const RepeatedMeasures found = repeated_measures(y);
  EXPECT_NEAR(found.f, 200, 1e-6);
  EXPECT_NEAR(found.epsilon, 1, 1e-9);
  const double c = std::sqrt(200.0 / 204.0);
  EXPECT_NEAR(found.p, 1 - c * (3 - c * c) / 2, 1e-9);
}

TEST(RepeatedMeasures, TestsNothingOfTooFewOrOfWhatLeavesNoError) {
  EXPECT_FALSE(repeated_measures({}).tested());
  const std::vector<std::vector<double>> two{{1, 2}, {2, 4}};
  EXPECT_FALSE(repeated_measures(two).tested());
  const std::vector<std::vector<double>> exact{{1, 2}, {2, 3}, {3, 4}};
  EXPECT_FALSE(repeated_measures(exact).tested());
  EXPECT_EQ(repeated_measures(exact).p, 1);
}

}  // namespace
}  // namespace steerid
