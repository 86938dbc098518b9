// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/certainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace steerid {
namespace {

// Relative changes that the excitation is measured in: a parameter's value, or, where that is small, the one that
// would matter to this inertia at half a hertz.
Eigen::Vector3d natural_scale(const WheelArm& wheel) {
  constexpr double kSlow = 2 * std::numbers::pi * 0.5;
  return {wheel.inertia_kgm2, std::max(std::abs(wheel.damping_nms_per_rad), 0.1 * kSlow * wheel.inertia_kgm2),
          std::max(std::abs(wheel.stiffness_nm_per_rad), 0.1 * kSlow * kSlow * wheel.inertia_kgm2)};
}

}  // namespace

Excitation excitation(const Eigen::MatrixXd& covariance, const WheelArm& wheel, double seen_sd) {
  const Eigen::Vector3d unit = natural_scale(wheel).cwiseInverse();
  const Eigen::Matrix3d relative = unit.asDiagonal() * covariance.topLeftCorner<3, 3>() * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(relative);
  Excitation out;
  for (int i = 0; i < 3; ++i) out.rank += eigen.eigenvalues()[i] <= seen_sd * seen_sd ? 1 : 0;
  out.smallest_singular_value = 1 / std::sqrt(eigen.eigenvalues()[2]);
  out.condition_number = std::sqrt(eigen.eigenvalues()[2] / std::max(eigen.eigenvalues()[0], 1e-300));
  out.unexcited_direction = eigen.eigenvectors().col(2);
  return out;
}

double convergence_factor(const NormalEquations& equations, const Eigen::MatrixXd& columns) {
  const Eigen::Index rest = columns.rows() - 3;
  Eigen::Matrix3d corner = columns.topRows<3>();
  corner = (corner + corner.transpose().eval()) / 2;
  const auto hessian_times = [&](const Eigen::VectorXd& v) {
    Eigen::VectorXd out(v.size());
    out.head<3>() = corner * v.head<3>() + columns.bottomRows(rest).transpose() * v.tail(rest);
    out.tail(rest) = columns.bottomRows(rest) * v.head<3>();
    return out;
  };
  Eigen::VectorXd v = Eigen::VectorXd::Zero(columns.rows());
  for (int k = 0; k < 3; ++k) v[k] = equations.diagonal[k] > 0 ? 1 / std::sqrt(equations.diagonal[k]) : 0;
  double factor = 0;
  for (int i = 0; i < 60; ++i) {
    const double length = std::sqrt(v.dot(equations.times(v)));
    if (!(length > 0)) return factor;
    v /= length;
    v = equations.solve(hessian_times(v));
    const double grown = std::sqrt(v.dot(equations.times(v)));
    if (std::abs(grown - factor) < 1e-6 * grown) return grown;
    factor = grown;
  }
  return factor;
}

FittedParameter judged(double value, double variance, bool may_be_negative, double valid_relative_sd) {
  FittedParameter out{value, std::sqrt(variance)};
  if (!std::isfinite(out.sd)) out.sd = std::numeric_limits<double>::infinity();
  out.model_misfit = !may_be_negative && value < -kNormal95 * out.sd;
  const bool sure = out.sd <= valid_relative_sd * std::abs(value);
  out.state = sure && (may_be_negative || value > 0) ? ParameterState::kValid : ParameterState::kNotExcited;
  return out;
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information, double variance, double unexcited) {
  const Eigen::VectorXd scale =
      information.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * information * scale.asDiagonal());
  const double floor = 1e-13 * eigen.eigenvalues().maxCoeff();
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([floor, unexcited](double l) { return l > floor ? 1 / l : unexcited; });
  return variance * (scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
                     eigen.eigenvectors().transpose() * scale.asDiagonal());
}

}  // namespace steerid
