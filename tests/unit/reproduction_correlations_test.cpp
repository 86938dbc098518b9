// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Correlations and their significance: against published examples.
#include <gtest/gtest.h>

#include <array>

#include "reproduction/correlations.hpp"

namespace steerid {
namespace {

// Anscombe (1973), The American Statistician 27, first data set: r = 0.81642, p = 0.00217.
TEST(Pearson, IsAnscombesFirst) {
  const std::vector<double> x{10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
  const std::vector<double> y{8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  const Association found = pearson(x, y);
  EXPECT_NEAR(found.coefficient, 0.81642, 5e-6);
  EXPECT_NEAR(found.p, 0.00217, 5e-6);
}

// Student's t with 1 degree of freedom is Cauchy's: p = 1 - 2/pi atan(t). Three points, r = 1/2: t = 1/sqrt(3), p =
// 2/3.
TEST(Pearson, HasStudentsTail) {
  const std::vector<double> x{1, 2, 3};
  const std::vector<double> y{0, 1, 0.5};  // centred (-1/2, 1/2, 0): r = (1/2)/sqrt(2 x 1/2)
  EXPECT_NEAR(pearson(x, y).coefficient, 0.5, 1e-12);
  EXPECT_NEAR(pearson(x, y).p, 2.0 / 3.0, 1e-12);
}

TEST(Pearson, SaysNothingOfWhatNeverVaries) {
  const std::vector<double> x{1, 2, 3, 4};
  const std::vector<double> y{7, 7, 7, 7};
  EXPECT_EQ(pearson(x, y).coefficient, 0);
  EXPECT_EQ(pearson(x, y).p, 1);
  EXPECT_EQ(pearson({}, {}).p, 1);
  EXPECT_EQ(pearson_paired({}, {}, {}).p, 1);
}

// One-way analysis of variance, three groups of six: F = 9.3, p = 0.0024; between 84 and within 68 squares
// (the worked example of Wikipedia's "One-way analysis of variance").
TEST(CorrelationRatio, IsTheAnalysisOfVariance) {
  const std::vector<double> y{6, 8, 4, 5, 3, 4, 8, 12, 9, 11, 6, 8, 13, 9, 11, 8, 7, 12};
  std::vector<std::size_t> label;
  for (std::size_t i = 0; i < y.size(); ++i) label.push_back(i / 6);
  const Association found = correlation_ratio(label, y);
  EXPECT_NEAR(found.coefficient, 84.0 / 152.0, 1e-12);
  EXPECT_NEAR(found.p, 0.0024, 5e-5);
}

// What a straight line through 1, 2, 3 cannot see: the middle class alone differs.
TEST(CorrelationRatio, SeesAPatternThatPearsonMisses) {
  const std::vector<double> y{1, 2, 11, 12, 1, 2};
  const std::vector<std::size_t> label{1, 1, 2, 2, 3, 3};
  const std::vector<double> x(label.begin(), label.end());
  EXPECT_NEAR(pearson(x, y).coefficient, 0, 1e-12);
  EXPECT_GT(correlation_ratio(label, y).coefficient, 0.98);
}

// Five groups far apart, each member of the second class 1 above the first of its group, give or take 0.1: alike in the
// plain correlation, plain to see once the groups' means are off. With two a group, r = mean/sqrt(mean of squares) of
// the differences (1.1, 0.9, 1.0, 1.2, 0.8).
TEST(PearsonPaired, TakesTheGroupsMeanOff) {
  const std::array differences{1.1, 0.9, 1.0, 1.2, 0.8};
  std::vector<double> x;
  std::vector<double> y;
  std::vector<std::size_t> group;
  double squares = 0;
  for (std::size_t g = 0; g < differences.size(); ++g) {
    for (const double side : {0.0, 1.0}) {
      x.push_back(side);
      y.push_back(100.0 * static_cast<double>(g * g) + side * differences[g]);
      group.push_back(g);
    }
    squares += differences[g] * differences[g] / 5;
  }
  EXPECT_LT(pearson(x, y).coefficient, 0.01);
  EXPECT_NEAR(pearson_paired(x, y, group).coefficient, 1.0 / std::sqrt(squares), 1e-9);
  EXPECT_LT(pearson_paired(x, y, group).p, 1e-3);
}

// p = 0.01, 0.04, 0.03, 0.005. Holm: 4 x 0.005, 3 x 0.01, 2 x 0.03, then not below the one before. Benjamini and
// Hochberg: 0.04 x 4/4, 0.03 x 4/3, 0.01 x 4/2, 0.005 x 4.
TEST(ManyTests, AreCorrected) {
  const std::vector<double> p{0.01, 0.04, 0.03, 0.005};
  const std::vector<double> family{0.03, 0.06, 0.06, 0.02};
  const std::vector<double> rate{0.02, 0.04, 0.04, 0.02};
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(holm(p)[i], family[i], 1e-15);
    EXPECT_NEAR(benjamini_hochberg(p)[i], rate[i], 1e-15);
  }
  EXPECT_EQ(holm(std::vector<double>{0.6, 0.9})[1], 1.0);  // never above 1
}

}  // namespace
}  // namespace steerid
