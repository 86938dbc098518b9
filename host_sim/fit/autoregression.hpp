// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The colour of a fit's residual as an autoregressive process, and the filter that whitens it.
//
// Angle noise is white, but torque noise and a driver's unmeasured torque reach the angle through 1/(J s^2 + B s + C):
// the residual of an output-error fit is coloured. Fitted as if it were white, it is weighted wrongly and its
// covariance is wrong, often by a factor of ten in C.
//
// Order p is chosen by Akaike's criterion with the correction for short records (Hurvich and Tsai 1989); coefficients
// come from Burg's method (Marple, Digital Spectral Analysis, 1987), pooled over gap-free segments. It keeps the
// process stable, and gives the prediction-error filters of all lower orders on its way: these whiten the first p
// samples of a segment, which makes the whitening exact (the Cholesky factor of the inverse covariance).
// A process may also be given by its autocovariance (fit/wheel_noise.hpp).
// Samples are taken as equally spaced; jitter within a period is harmless.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace steerid {

class Autoregression {
 public:
  /// White noise: order 0, and whiten() changes nothing.
  Autoregression() = default;

  /// Fits the residuals of gap-free segments.
  static Autoregression fit(std::span<const Eigen::VectorXd> residuals, int max_order);

  /// The process with the autocovariance c_0, c_1 .. (Levinson's recursion), of which `numbers` beside c_0 were
  /// estimated. No longer than it takes for the prediction-error power to come within `relative_loss` of the last
  /// order's. Nothing when c is no autocovariance to working precision.
  static std::optional<Autoregression> from_autocovariance(std::span<const double> c, int numbers,
                                                           double relative_loss);

  [[nodiscard]] int order() const { return static_cast<int>(predictors_.size()); }

  /// Numbers that were estimated for it, a variance apart.
  [[nodiscard]] int numbers() const { return numbers_; }

  /// a_1 .. a_p of e_i = y_i + a_1 y_(i-1) + ... + a_p y_(i-p), e white.
  [[nodiscard]] std::span<const double> coefficients() const;

  /// Columns that are whitened together: one row a sample.
  static constexpr int kColumns = 8;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kColumns, Eigen::RowMajor>;

  /// Prediction errors of every column, scaled to one variance from the first sample on. Cost: order x 8 products a
  /// row.
  void whiten(const Rows& rows, Rows& white) const;

  /// -2 log likelihood of gap-free segments, up to a constant, of the best variance.
  [[nodiscard]] double misfit(std::span<const Eigen::VectorXd> segments) const;

 private:
  Autoregression(std::vector<std::vector<double>> predictors, std::span<const double> powers, int numbers);

  std::vector<std::vector<double>> predictors_;  // [k - 1] holds a_1 .. a_k of order k
  std::vector<double> start_scale_;              // [k]: sqrt(P_p / P_k), P_k the prediction-error power of order k
  int numbers_ = 0;
};

}  // namespace steerid
