// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The smoother against the closed form: of numbers that wander and a noisy sum of them a row everything is Gaussian, so
// that the covariance of all rows can be written down and inverted at once.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include "fit/random_walk.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

TEST(RandomWalk, SmoothsAsTheInverseOfTheWholeCovarianceDoes) {
  std::mt19937_64 random(test::seed(1));
  std::normal_distribution<double> normal;
  constexpr Eigen::Index kRows = 60;
  const RandomWalk walk{
      .start = {0.1, 1.5, 20, 0}, .start_variance = {1, 100, 1e4, 10}, .variance_per_s = {0, 0.3, 40, 0}};
  Eigen::Matrix<double, Eigen::Dynamic, 4> z(kRows, 4);
  Eigen::VectorXd y(kRows);
  std::vector<double> time_s;
  for (Eigen::Index k = 0; k < kRows; ++k) {
    z.row(k) << 30 * normal(random), 2 * normal(random), 0.1 * normal(random), 1;
    y[k] = normal(random) + z.row(k).dot(walk.start);
    time_s.push_back(0.04 * static_cast<double>(k) + (k > 30 ? 5 : 0));  // with a gap
  }
  const auto shared_s = [&](Eigen::Index j, Eigen::Index k) {
    return time_s[static_cast<std::size_t>(std::min(j, k))] - time_s[0];
  };
  const auto covariance = [&](Eigen::Index j, Eigen::Index k) -> Eigen::Vector4d {
    return walk.start_variance + walk.variance_per_s * shared_s(j, k);
  };
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(kRows, kRows);
  for (Eigen::Index j = 0; j < kRows; ++j) {
    for (Eigen::Index k = 0; k < kRows; ++k) {
      all(j, k) += (z.row(j).transpose().array() * covariance(j, k).array() * z.row(k).transpose().array()).sum();
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> solver(all);
  const Eigen::VectorXd off = y - z * walk.start;
  const double variance = off.dot(solver.solve(off)) / kRows;
  const double log_determinant = 2 * Eigen::MatrixXd(solver.matrixL()).diagonal().array().log().sum();

  const SmoothedWalk smoothed = smooth_walk(y, z, time_s, walk);
  EXPECT_NEAR(smoothed.variance, variance, 1e-9 * variance);
  EXPECT_NEAR(smoothed.log_likelihood, -0.5 * (kRows * std::log(variance) + log_determinant), 1e-7);
  EXPECT_EQ(log_likelihood(y, z, time_s, walk), smoothed.log_likelihood);
  for (const Eigen::Index k : {Eigen::Index{0}, Eigen::Index{17}, Eigen::Index{31}, kRows - 1}) {
    for (int i = 0; i < 4; ++i) {
      Eigen::VectorXd with(kRows);
      for (Eigen::Index j = 0; j < kRows; ++j) with[j] = covariance(k, j)[i] * z(j, i);
      const double value = walk.start[i] + with.dot(solver.solve(off));
      const double sd = std::sqrt(variance * (covariance(k, k)[i] - with.dot(solver.solve(with))));
      const auto row = static_cast<std::size_t>(k);
      EXPECT_NEAR(smoothed.value[row][i], value, 1e-6 * sd) << k << " " << i;
      EXPECT_NEAR(smoothed.sd[row][i], sd, 1e-6 * sd) << k << " " << i;
    }
  }
}

}  // namespace
}  // namespace steerid
