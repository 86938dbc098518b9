// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Four numbers that wander, from one noisy sum of them a row: fixed-interval smoothing.
//
//   y_k = z_k' p_k + e_k,  e_k of variance s^2;   p_k = p_(k-1) + w_k,  w_k of variance s^2 walk (t_k - t_(k-1))
//
// Kalman filter forwards, Rauch, Tung and Striebel (1965, AIAA Journal 3) backwards. All variances are counted in s^2,
// which is then the likeliest one in closed form; the likelihood of the walk is what remains (Harvey, Forecasting,
// Structural Time Series Models and the Kalman Filter, 1989, section 3.4).
//
// Cost: 1 us a row.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace steerid {

/// Where the numbers are before the first row, and how fast they wander.
struct RandomWalk {
  Eigen::Vector4d start;
  Eigen::Vector4d start_variance;                           ///< over s^2; large where nothing is known
  Eigen::Vector4d variance_per_s{Eigen::Vector4d::Zero()};  ///< over s^2; 0: the number stays
};

struct SmoothedWalk {
  std::vector<Eigen::Vector4d> value;  ///< one a row
  std::vector<Eigen::Vector4d> sd;     ///< likewise
  double variance = 0;                 ///< s^2
  double log_likelihood = 0;           ///< of the best s^2, up to a constant of the number of rows
};

/// As many rows in `y`, `z` and `time_s`, at least one; time rises.
[[nodiscard]] SmoothedWalk smooth_walk(const Eigen::VectorXd& y, const Eigen::Matrix<double, Eigen::Dynamic, 4>& z,
                                       std::span<const double> time_s, const RandomWalk& walk);

/// Only its likelihood, forwards.
[[nodiscard]] double log_likelihood(const Eigen::VectorXd& y, const Eigen::Matrix<double, Eigen::Dynamic, 4>& z,
                                    std::span<const double> time_s, const RandomWalk& walk);

}  // namespace steerid
