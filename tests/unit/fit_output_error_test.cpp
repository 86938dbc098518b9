// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "fit/output_error.hpp"
#include "fit/segments.hpp"

namespace {

using steerid::OutputError;
using steerid::Record;

// Two segments, half a second lost between them.
Record record_with_gap() {
  Record record;
  for (int i = 0; i < 500; ++i) {
    if (i > 200 && i < 250) continue;
    const double t = 0.01 * i;
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(std::sin(5 * t) + std::cos(13 * t));
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(0.03 * std::sin(5 * t - 0.2));
  }
  return record;
}

// J C J' sample by sample, J by central differences of the residual.
TEST(OutputError, WhatIsAbsorbedHasTheCovarianceOfTheFittedAngle) {
  OutputError problem(gap_free_segments(record_with_gap(), steerid::TorqueSignal::Between::kBandLimited), false);
  ASSERT_EQ(problem.segments().size(), 2U);
  const Eigen::VectorXd x = problem.complete({0.1, 1.2, 20}).x;
  Eigen::Matrix3d covariance;
  covariance << 4e-6, 1e-6, -3e-5, 1e-6, 9e-5, 2e-4, -3e-5, 2e-4, 8e-3;

  std::vector<Eigen::MatrixXd> jacobian;
  for (const steerid::Segment& segment : problem.segments()) {
    jacobian.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(segment.size()), 3));
  }
  for (int k = 0; k < 3; ++k) {
    const double step = 1e-5 * x[k];
    for (const double side : {1.0, -1.0}) {
      Eigen::VectorXd moved = x;
      moved[k] += side * step;
      (void)problem.evaluate(moved);
      const std::vector<Eigen::VectorXd> residuals = problem.residuals();
      for (std::size_t s = 0; s < 2; ++s) jacobian[s].col(k) += side / (2 * step) * residuals[s];
    }
  }
  (void)problem.evaluate(x);
  const std::vector<Eigen::VectorXd> absorbed = problem.absorbed(covariance);
  ASSERT_EQ(absorbed.size(), 6U);  // three a segment
  for (std::size_t s = 0; s < 2; ++s) {
    const Eigen::MatrixXd expected = jacobian[s] * covariance * jacobian[s].transpose();
    Eigen::MatrixXd actual = Eigen::MatrixXd::Zero(expected.rows(), expected.cols());
    for (std::size_t i = 0; i < 3; ++i) actual += absorbed[3 * s + i] * absorbed[3 * s + i].transpose();
    EXPECT_LT((actual - expected).norm(), 1e-6 * expected.norm());
  }
}

}  // namespace
