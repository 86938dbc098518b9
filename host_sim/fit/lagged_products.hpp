// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The power of prediction errors for any predictor, without going through the samples again: sums of the products of
// samples y_(i-j) y_(i-k), j and k up to the longest predictor (the covariance method of Marple, Digital Spectral
// Analysis, 1987). With e_i = y_i + a_1 y_(i-1) + ..., sum e_i^2 = (1, a)' R (1, a).
//
// Only samples with a whole memory behind them count. So that most of them do, the memory is shortened where segments
// are short.
#pragma once

#include <Eigen/Core>
#include <span>

namespace steerid {

class LaggedProducts {
 public:
  /// Of the residuals of gap-free segments, with the products of `absorbed` added (OutputError::absorbed()). Cost:
  /// samples x max_order products.
  LaggedProducts(std::span<const Eigen::VectorXd> residuals, std::span<const Eigen::VectorXd> absorbed, int max_order);

  /// The longest predictor: at most max_order, and so short that half of the samples have it behind them.
  [[nodiscard]] int order() const { return order_; }
  /// Prediction errors that are summed.
  [[nodiscard]] double rows() const { return rows_; }
  /// Sum of the squared prediction errors; `predictor` holds a_1, a_2 .., at most order() of them.
  [[nodiscard]] double squares(std::span<const double> predictor) const;

 private:
  void add(const Eigen::VectorXd& series);

  int order_ = 0;
  double rows_ = 0;
  Eigen::MatrixXd products_;
};

}  // namespace steerid
