// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/lagged_products.hpp"

#include <algorithm>

namespace steerid {
namespace {

/// Samples with `memory` others behind them in their segment.
double samples_beyond(std::span<const Eigen::VectorXd> segments, Eigen::Index memory) {
  double count = 0;
  for (const Eigen::VectorXd& one : segments)
    count += static_cast<double>(std::max<Eigen::Index>(one.size() - memory, 0));
  return count;
}

}  // namespace

LaggedProducts::LaggedProducts(std::span<const Eigen::VectorXd> residuals, std::span<const Eigen::VectorXd> absorbed,
                               int max_order)
    : order_(max_order) {
  const double half = samples_beyond(residuals, 0) / 2;
  while (order_ > 0 && samples_beyond(residuals, order_) < half) --order_;
  rows_ = samples_beyond(residuals, order_);
  products_ = Eigen::MatrixXd::Zero(order_ + 1, order_ + 1);
  for (const Eigen::VectorXd& series : residuals) add(series);
  for (const Eigen::VectorXd& series : absorbed) add(series);
}

// The first row by going through the samples; further rows differ from the one above by the products at both ends.
void LaggedProducts::add(const Eigen::VectorXd& series) {
  const Eigen::Index p = order_;
  const Eigen::Index rows = series.size() - p;
  if (rows < 1) return;
  Eigen::MatrixXd own(p + 1, p + 1);
  for (Eigen::Index k = 0; k <= p; ++k) own(0, k) = series.tail(rows).dot(series.segment(p - k, rows));
  for (Eigen::Index j = 1; j <= p; ++j) {
    for (Eigen::Index k = j; k <= p; ++k) {
      own(j, k) = own(j - 1, k - 1) + series[p - j] * series[p - k] - series[p + rows - j] * series[p + rows - k];
    }
  }
  products_ += own.triangularView<Eigen::Upper>();
}

double LaggedProducts::squares(std::span<const double> predictor) const {
  Eigen::VectorXd a = Eigen::VectorXd::Zero(order_ + 1);
  a[0] = 1;
  for (std::size_t k = 0; k < predictor.size(); ++k) a[static_cast<Eigen::Index>(k) + 1] = predictor[k];
  return a.dot(products_.selfadjointView<Eigen::Upper>() * a);
}

}  // namespace steerid
