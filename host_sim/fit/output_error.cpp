// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/output_error.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace steerid {
namespace {

// Columns of the rows that are whitened together: the sensitivities as linear_response.hpp orders them, the residual.
constexpr Eigen::Index kResidual = kSensitivityColumns;

// Directions whose eigenvalue, after scaling the diagonal to one, lies below this carry no information: squared
// rounding errors of a double would fill them.
constexpr double kNoInformation = 1e-13;

// Symmetric positive semidefinite solve with a scaled diagonal that leaves unexcited directions alone.
Eigen::VectorXd solve_scaled(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& rhs) {
  const Eigen::VectorXd scale = matrix.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * matrix * scale.asDiagonal());
  const double floor = kNoInformation * eigen.eigenvalues().maxCoeff();
  Eigen::VectorXd along = eigen.eigenvectors().transpose() * (scale.asDiagonal() * rhs);
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    along[i] = eigen.eigenvalues()[i] > floor ? along[i] / eigen.eigenvalues()[i] : 0;
  }
  return scale.asDiagonal() * (eigen.eigenvectors() * along);
}

// The inverse of a segment's own block; of its first unknown alone when the two cannot be told apart.
Eigen::Matrix2d inverse_or_part(const Eigen::Matrix2d& own) {
  if (own.determinant() > kNoInformation * own(0, 0) * own(1, 1)) return own.inverse();
  Eigen::Matrix2d part = Eigen::Matrix2d::Zero();
  if (own(0, 0) > 0) part(0, 0) = 1 / own(0, 0);
  return part;
}

// Where each unknown of one segment stands among the sensitivity columns: shared ones first, then its initial state.
std::vector<int> columns_of(int shared) {
  std::vector<int> columns = {kByInertia, kByDamping, kByStiffness};
  if (shared > 3) columns.push_back(kByTorqueOffset);
  columns.push_back(kByInitialAngle);
  columns.push_back(kByInitialRate);
  return columns;
}

}  // namespace

NormalEquations::NormalEquations(int shared, std::size_t segments)
    : gradient(Eigen::VectorXd::Zero(shared + 2 * static_cast<Eigen::Index>(segments))),
      diagonal(gradient),
      shared_(shared),
      corner_(Eigen::MatrixXd::Zero(shared, shared)),
      border_(segments, Eigen::MatrixXd::Zero(shared, 2)),
      inverse_(segments, Eigen::Matrix2d::Zero()),
      own_(segments, Eigen::Matrix2d::Zero()) {}

void NormalEquations::add(std::size_t segment, const Eigen::MatrixXd& gram) {
  const Eigen::Index m = shared_;
  const Eigen::Index own = m + 2 * static_cast<Eigen::Index>(segment);
  corner_ += gram.topLeftCorner(m, m);
  border_[segment] = gram.block(0, m, m, 2);
  own_[segment] = gram.block<2, 2>(m, m);
  inverse_[segment] = inverse_or_part(own_[segment]);
  gradient.head(m) += gram.block(0, m + 2, m, 1);
  gradient.segment<2>(own) = gram.block<2, 1>(m, m + 2);
  diagonal.head(m) += gram.diagonal().head(m);
  diagonal.segment<2>(own) = gram.diagonal().segment<2>(m);
  cost += gram(m + 2, m + 2) / 2;
}

Eigen::MatrixXd NormalEquations::shared_information() const {
  Eigen::MatrixXd information = corner_;
  for (std::size_t s = 0; s < border_.size(); ++s) information -= border_[s] * inverse_[s] * border_[s].transpose();
  return information;
}

Eigen::VectorXd NormalEquations::solve(const Eigen::VectorXd& rhs, int fixed) const {
  Eigen::VectorXd reduced = rhs.head(shared_);
  for (std::size_t s = 0; s < border_.size(); ++s) {
    reduced -= border_[s] * (inverse_[s] * rhs.segment<2>(shared_ + 2 * static_cast<Eigen::Index>(s)));
  }
  const Eigen::Index moving = shared_ - fixed;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rhs.size());
  if (moving > 0) {
    out.segment(fixed, moving) =
        solve_scaled(shared_information().bottomRightCorner(moving, moving), reduced.tail(moving));
  }
  for (std::size_t s = 0; s < border_.size(); ++s) {
    const Eigen::Index own = shared_ + 2 * static_cast<Eigen::Index>(s);
    out.segment<2>(own) = inverse_[s] * (rhs.segment<2>(own) - border_[s].transpose() * out.head(shared_));
  }
  return out;
}

Eigen::VectorXd NormalEquations::times(const Eigen::VectorXd& v) const {
  Eigen::VectorXd out(v.size());
  out.head(shared_) = corner_ * v.head(shared_);
  for (std::size_t s = 0; s < border_.size(); ++s) {
    const Eigen::Index own = shared_ + 2 * static_cast<Eigen::Index>(s);
    out.head(shared_) += border_[s] * v.segment<2>(own);
    out.segment<2>(own) = border_[s].transpose() * v.head(shared_) + own_[s] * v.segment<2>(own);
  }
  return out;
}

OutputError::OutputError(std::vector<Segment> segments, bool torque_offset)
    : segments_(std::move(segments)),
      shared_(torque_offset ? 4 : 3),
      rows_(segments_.size()),
      white_(segments_.size()) {
  for (const Segment& segment : segments_) {
    samples_ += segment.size();
    for (const double angle : segment.angle_rad) rounding_power_ += 1e-26 * angle * angle;
  }
}

Unknowns OutputError::named(const Eigen::VectorXd& x) const {
  Unknowns out{{x[0], x[1], x[2]}, shared_ > 3 ? x[3] : 0, {}};
  for (Eigen::Index i = shared_; i < x.size(); i += 2) out.initial.push_back({x[i], x[i + 1]});
  return out;
}

void OutputError::fill_rows(const Eigen::VectorXd& x, std::size_t segment, Rows& rows) {
  const Unknowns at = named(x);
  const Segment& part = segments_[segment];
  free_run_sensitivities(at.wheel, part.torque, part.time_s, at.initial[segment], at.torque_offset_nm, run_);
  rows.resize(run_.by.rows(), Eigen::NoChange);
  rows.leftCols<kSensitivityColumns>() = -run_.by;  // of the residual
  rows.col(kResidual) = Eigen::Map<const Eigen::VectorXd>(part.angle_rad.data(), run_.by.rows()) - run_.angle_rad;
  rows.col(kResidual + 1).setZero();
}

const OutputError::Rows& OutputError::whitened(std::size_t segment) {
  if (noise_.order() == 0) return rows_[segment];
  noise_.whiten(rows_[segment], white_[segment]);
  return white_[segment];
}

NormalEquations OutputError::evaluate(const Eigen::VectorXd& x) {
  NormalEquations equations(shared_, segments_.size());
  std::vector<int> columns = columns_of(shared_);
  columns.push_back(kResidual);
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    fill_rows(x, s, rows_[s]);
    const Rows& white = whitened(s);
    const Eigen::Matrix<double, Autoregression::kColumns, Autoregression::kColumns> gram = white.transpose() * white;
    equations.add(s, gram(columns, columns));
  }
  return equations;
}

std::vector<Eigen::VectorXd> OutputError::residuals() const {
  std::vector<Eigen::VectorXd> out;
  for (const Rows& rows : rows_) out.emplace_back(rows.col(kResidual));
  return out;
}

std::vector<Eigen::VectorXd> OutputError::absorbed(const Eigen::MatrixXd& covariance) const {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const Eigen::MatrixXd root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  std::vector<int> columns = columns_of(shared_);
  columns.resize(static_cast<std::size_t>(shared_));
  std::vector<Eigen::VectorXd> out;
  for (const Rows& rows : rows_) {
    const Eigen::MatrixXd taken = rows(Eigen::all, columns) * root;
    for (int i = 0; i < shared_; ++i) out.emplace_back(taken.col(i));
  }
  return out;
}

Eigen::MatrixXd OutputError::curvature_columns(const Eigen::VectorXd& x) {
  constexpr double kRelativeStep = 1e-5;  // truncation 1e-5 of H, cancellation eps/1e-5 of J'r
  const std::vector<int> columns = columns_of(shared_);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(x.size(), 3);
  Rows rows;
  Rows changed;
  for (int k = 0; k < 3; ++k) {
    Eigen::VectorXd moved = x;
    // A stiffness of zero still needs a step: the one that matters at about 1 Hz.
    const double floor = k == kByInertia ? 0 : (k == kByDamping ? 6.0 : 40.0) * x[kByInertia];
    const double step = kRelativeStep * std::max(std::abs(x[k]), floor);
    moved[k] += step;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      fill_rows(moved, s, rows);
      noise_.whiten(rows, changed);
      const Rows& here = noise_.order() == 0 ? rows_[s] : white_[s];
      const Eigen::VectorXd residual = here.col(kResidual);
      changed -= here;
      const Eigen::VectorXd change = changed.leftCols<kSensitivityColumns>().transpose() * residual / step;
      const Eigen::Index own = shared_ + 2 * static_cast<Eigen::Index>(s);
      for (int i = 0; i < shared_; ++i) out(i, k) += change[columns[static_cast<std::size_t>(i)]];
      out(own, k) += change[kByInitialAngle];
      out(own + 1, k) += change[kByInitialRate];
    }
  }
  return out;
}

OutputError::Completed OutputError::complete(const WheelArm& wheel) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(unknowns());
  x.head<3>() << wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad;
  const NormalEquations equations = evaluate(x);
  const Eigen::VectorXd step = -equations.solve(equations.gradient, 3);
  return {x + step, equations.cost + equations.gradient.dot(step) / 2};
}

}  // namespace steerid
