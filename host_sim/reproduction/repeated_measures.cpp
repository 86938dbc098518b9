// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/repeated_measures.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <unsupported/Eigen/SpecialFunctions>

namespace steerid {

double incomplete_beta(double x, double a, double b) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return Eigen::numext::betainc(a, b, x);
}

RepeatedMeasures repeated_measures(std::span<const std::vector<double>> y) {
  RepeatedMeasures out;
  out.subjects = y.size();
  const std::size_t levels = y.empty() ? 0 : y.front().size();
  if (y.size() < 3 || levels < 2) return out;
  const auto n = static_cast<Eigen::Index>(y.size());
  const auto k = static_cast<Eigen::Index>(levels);
  Eigen::MatrixXd table(n, k);
  for (Eigen::Index s = 0; s < n; ++s) {
    for (Eigen::Index level = 0; level < k; ++level) {
      table(s, level) = y[static_cast<std::size_t>(s)][static_cast<std::size_t>(level)];
    }
  }
  const Eigen::RowVectorXd means = table.colwise().mean();
  const Eigen::MatrixXd centred = table.rowwise() - means;
  const Eigen::MatrixXd error = centred.colwise() - centred.rowwise().mean();
  const double between = static_cast<double>(n) * (means.array() - means.mean()).square().sum();
  const double within = error.squaredNorm();
  if (!(within > 0)) return out;

  // The covariance of the levels, centred both ways, is that of `error`: epsilon = tr(S)^2/((k - 1) tr(S S)).
  const Eigen::MatrixXd covariance = error.transpose() * error;
  const double trace = covariance.trace();
  out.epsilon = trace * trace / (static_cast<double>(k - 1) * covariance.squaredNorm());
  out.level_mean.assign(means.begin(), means.end());
  out.f = between / out.between() / (within / out.within());
  out.partial_eta_squared = between / (between + within);
  const double above = out.epsilon * out.between();
  const double below = out.epsilon * out.within();
  out.p = incomplete_beta(below / (below + above * out.f), below / 2, above / 2);
  return out;
}

}  // namespace steerid
