// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/sets/projection.hpp"

#include <Eigen/QR>
#include <iterator>

namespace steerid::gap {
namespace {

Eigen::VectorXd padded(const Eigen::VectorXd& rows, Eigen::Index by) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows.size() + by);
  out.head(rows.size()) = rows;
  return out;
}

}  // namespace

Projection::Projection(const Whittle::Whitened& whitened, const std::vector<Spectrum>& slopes,
                       const std::vector<double>& prior_sd)
    : priors_(std::ssize(prior_sd)) {
  std::vector<Eigen::VectorXd> moved;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const bool known = i < prior_sd.size();
    Eigen::VectorXd rows = padded(whitened(known ? Spectrum(prior_sd[i] * slopes[i]) : slopes[i]), priors_);
    if (known) rows[whitened.rows() + static_cast<Eigen::Index>(i)] = 1;
    if (const double norm = rows.norm(); norm > 1e-300) moved.emplace_back(rows / norm);
  }
  Eigen::MatrixXd columns(whitened.rows() + priors_, std::ssize(moved));
  for (Eigen::Index i = 0; i < columns.cols(); ++i) columns.col(i) = moved[static_cast<std::size_t>(i)];
  explained_ = columns;
  if (columns.cols() == 0) return;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  explained_ = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

Eigen::VectorXd Projection::of(const Whittle::Whitened& whitened, const Spectrum& signal) const {
  Eigen::VectorXd rows = padded(whitened(signal), priors_);
  rows -= explained_ * (explained_.transpose() * rows).eval();
  return rows;
}

}  // namespace steerid::gap
