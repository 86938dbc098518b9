// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "fit/autoregression.hpp"
#include "support/seed.hpp"

namespace {

using steerid::Autoregression;

Eigen::VectorXd white(Eigen::Index samples, std::mt19937_64& random) {
  Eigen::VectorXd out(samples);
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  for (double& v : out) v = std::sqrt(-2 * std::log(uniform())) * std::cos(2 * std::numbers::pi * uniform());
  return out;
}

Autoregression::Rows white_rows(Eigen::Index samples, std::mt19937_64& random) {
  Autoregression::Rows rows(samples, Autoregression::kColumns);
  for (Eigen::Index column = 0; column < rows.cols(); ++column) rows.col(column) = white(samples, random);
  return rows;
}

Eigen::VectorXd second_order(Eigen::Index samples, std::mt19937_64& random) {
  const Eigen::VectorXd e = white(samples + 500, random);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(samples + 500);
  for (Eigen::Index i = 2; i < y.size(); ++i) y[i] = 1.5 * y[i - 1] - 0.7 * y[i - 2] + e[i];
  return y.tail(samples);
}

TEST(Autoregression, FindsAKnownProcess) {
  std::mt19937_64 random(steerid::test::seed(11));
  const std::vector<Eigen::VectorXd> segments = {second_order(6000, random), second_order(4000, random)};
  const Autoregression model = Autoregression::fit(segments, 30);
  ASSERT_GE(model.order(), 2);
  // standard error of an AR(2) coefficient: sqrt((1 - 0.7^2)/10000) = 0.0071, and a few orders too many add little
  EXPECT_NEAR(model.coefficients()[0], -1.5, 0.05);
  EXPECT_NEAR(model.coefficients()[1], 0.7, 0.08);
}

TEST(Autoregression, LeavesWhiteNoiseAlone) {
  std::mt19937_64 random(steerid::test::seed(12));
  int total = 0;
  for (int i = 0; i < 20; ++i) total += Autoregression::fit(std::vector{white(3000, random)}, 30).order();
  EXPECT_LT(total, 60);  // Akaike's criterion overfits white noise by one or two orders on average
}

// The whitened sum of squares must be y' R^-1 y up to one factor, R the Toeplitz covariance of the estimated process:
// that is what "exact from the first sample" means. R comes from the coefficients by solving Yule-Walker here.
TEST(Autoregression, WhiteningIsTheCholeskyFactorOfTheInverseCovariance) {
  std::mt19937_64 random(steerid::test::seed(13));
  const Autoregression model = Autoregression::fit(std::vector{second_order(5000, random)}, 2);
  ASSERT_EQ(model.order(), 2);
  const double a1 = model.coefficients()[0];
  const double a2 = model.coefficients()[1];
  constexpr int kLength = 12;
  Eigen::VectorXd covariance(kLength);
  covariance[0] = (1 + a2) / ((1 - a2) * ((1 + a2) * (1 + a2) - a1 * a1));  // unit innovations
  covariance[1] = -a1 / (1 + a2) * covariance[0];
  for (int k = 2; k < kLength; ++k) covariance[k] = -a1 * covariance[k - 1] - a2 * covariance[k - 2];
  Eigen::MatrixXd toeplitz(kLength, kLength);
  for (int i = 0; i < kLength; ++i) {
    for (int j = 0; j < kLength; ++j) toeplitz(i, j) = covariance[std::abs(i - j)];
  }
  const Autoregression::Rows rows = white_rows(kLength, random);
  Autoregression::Rows out;
  model.whiten(rows, out);
  const Eigen::MatrixXd expected = rows.transpose() * toeplitz.inverse() * rows;
  const Eigen::MatrixXd actual = out.transpose() * out;
  EXPECT_LT((actual - expected).norm(), 1e-9 * expected.norm());
}

// Of an AR(2) process with known coefficients, by Yule-Walker; longer predictors gain nothing and are left away.
TEST(Autoregression, ComesBackFromItsAutocovariance) {
  constexpr double kA1 = -1.5;
  constexpr double kA2 = 0.7;
  std::vector<double> c = {1, -kA1 / (1 + kA2)};
  for (std::size_t k = 2; k < 20; ++k) c.push_back(-kA1 * c[k - 1] - kA2 * c[k - 2]);
  const auto model = Autoregression::from_autocovariance(c, 1, 1e-9);
  ASSERT_TRUE(model);
  ASSERT_EQ(model->order(), 2);
  EXPECT_EQ(model->numbers(), 1);
  EXPECT_NEAR(model->coefficients()[0], kA1, 1e-12);
  EXPECT_NEAR(model->coefficients()[1], kA2, 1e-12);
  EXPECT_FALSE(Autoregression::from_autocovariance(std::vector{1.0, 1.2}, 1, 0));  // no process has that
}

// -2 log likelihood of a normal vector with the best variance: n log(y' R^-1 y / n) + log det R.
TEST(Autoregression, MisfitIsTheLikelihoodOfTheToeplitzCovariance) {
  constexpr int kLength = 9;
  std::vector<double> c;
  for (int k = 0; k < kLength; ++k) c.push_back(std::pow(0.8, k) + (k == 0 ? 0.5 : 0.0));
  const auto model = Autoregression::from_autocovariance(c, 1, 0);
  ASSERT_TRUE(model);
  Eigen::MatrixXd toeplitz(kLength, kLength);
  for (int i = 0; i < kLength; ++i) {
    for (int j = 0; j < kLength; ++j) toeplitz(i, j) = c[static_cast<std::size_t>(std::abs(i - j))];
  }
  std::mt19937_64 random(steerid::test::seed(14));
  const std::vector<Eigen::VectorXd> segments = {white(kLength, random), white(kLength, random)};
  double squares = 0;
  for (const Eigen::VectorXd& y : segments) squares += y.dot(toeplitz.inverse() * y);
  const double expected = 2 * kLength * std::log(squares / (2 * kLength)) + 2 * std::log(toeplitz.determinant());
  EXPECT_NEAR(model->misfit(segments), expected, 1e-9);
}

TEST(Autoregression, WhiteModelChangesNothing) {
  std::mt19937_64 random(steerid::test::seed(15));
  const Autoregression::Rows rows = white_rows(5, random);
  Autoregression::Rows out;
  Autoregression().whiten(rows, out);
  EXPECT_EQ(out, rows);
}

}  // namespace
