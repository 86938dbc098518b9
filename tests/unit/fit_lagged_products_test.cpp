// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>
#include <vector>

#include "fit/lagged_products.hpp"
#include "support/seed.hpp"

namespace {

using steerid::LaggedProducts;

/// Even between -1 and 1.
Eigen::VectorXd drawn(Eigen::Index samples, std::mt19937_64& random) {
  Eigen::VectorXd out(samples);
  for (double& v : out) v = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
  return out;
}

double direct(const Eigen::VectorXd& y, const std::vector<double>& a, Eigen::Index first) {
  double sum = 0;
  for (Eigen::Index i = first; i < y.size(); ++i) {
    double error = y[i];
    for (std::size_t k = 0; k < a.size(); ++k) error += a[k] * y[i - 1 - static_cast<Eigen::Index>(k)];
    sum += error * error;
  }
  return sum;
}

TEST(LaggedProducts, GiveTheSquaresOfAnyPredictor) {
  std::mt19937_64 random(steerid::test::seed(41));
  const std::vector<Eigen::VectorXd> residuals = {drawn(60, random), drawn(45, random)};
  const std::vector<Eigen::VectorXd> absorbed = {drawn(60, random)};
  const LaggedProducts products(residuals, absorbed, 5);
  ASSERT_EQ(products.order(), 5);
  EXPECT_EQ(products.rows(), 55 + 40);
  for (const std::vector<double>& a : {std::vector<double>{}, {-0.9}, {0.3, -1.1, 0.2, 0.7, -0.4}}) {
    const double expected = direct(residuals[0], a, 5) + direct(residuals[1], a, 5) + direct(absorbed[0], a, 5);
    EXPECT_NEAR(products.squares(a), expected, 1e-12 * expected);
  }
}

TEST(LaggedProducts, RememberLessWhereSegmentsAreShort) {
  std::mt19937_64 random(steerid::test::seed(42));
  const std::vector<Eigen::VectorXd> residuals(10, drawn(30, random));
  const LaggedProducts products(residuals, {}, 100);
  EXPECT_EQ(products.order(), 15);
  EXPECT_EQ(products.rows(), 150);
}

}  // namespace
