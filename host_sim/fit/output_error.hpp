// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The nonlinear least squares problem of section III of Lv et al. 2018: residuals r = measured angle - free run
// (equation 6), f = r'r/2 (7), their Jacobian (8), gradient J'r (9), in the whitened form W r, W J when the residual is
// coloured.
//
// Unknowns, in this order: J, B, C, optionally a constant torque offset, then the angle and rate at the start of each
// gap-free segment. A segment's initial state touches only its own rows, so J'J has the shape of an arrow; it is kept
// and solved as one, and a record with a thousand gaps costs no more than one without.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fit/autoregression.hpp"
#include "fit/segments.hpp"
#include "plant/linear_response.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

/// The normal equations at one point, arrow-shaped. `shared` is the number of unknowns common to all segments.
class NormalEquations {
 public:
  NormalEquations(int shared, std::size_t segments);

  double cost = 0;           ///< f = r'r/2
  Eigen::VectorXd gradient;  ///< J'r
  Eigen::VectorXd diagonal;  ///< of J'J: squared lengths of the Jacobian's columns

  /// Adds one segment's rows: columns of the residual's Jacobian for the shared unknowns, its two own, the residual.
  void add(std::size_t segment, const Eigen::MatrixXd& gram);

  /// (J'J)^-1 rhs. Directions without any information (to working precision) get no step, nor do the first `fixed`
  /// unknowns.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& rhs, int fixed = 0) const;
  /// J'J v.
  [[nodiscard]] Eigen::VectorXd times(const Eigen::VectorXd& v) const;
  /// The information on the shared unknowns that is left when the initial states are unknown: the Schur complement.
  [[nodiscard]] Eigen::MatrixXd shared_information() const;

 private:
  int shared_;
  Eigen::MatrixXd corner_;                // shared x shared
  std::vector<Eigen::MatrixXd> border_;   // a segment: shared x 2
  std::vector<Eigen::Matrix2d> inverse_;  // a segment: inverse of its own 2 x 2 block
  std::vector<Eigen::Matrix2d> own_;
};

/// One vector of unknowns, named.
struct Unknowns {
  WheelArm wheel;
  double torque_offset_nm = 0;
  std::vector<WheelState> initial;
};

class OutputError {
 public:
  OutputError(std::vector<Segment> segments, bool torque_offset);

  [[nodiscard]] int shared() const { return shared_; }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  /// r'r that rounding alone leaves: 1e-13 of the angle, squared and summed.
  [[nodiscard]] double rounding_power() const { return rounding_power_; }
  [[nodiscard]] Eigen::Index unknowns() const { return shared_ + 2 * static_cast<Eigen::Index>(segments_.size()); }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

  void set_noise(Autoregression noise) { noise_ = std::move(noise); }
  [[nodiscard]] const Autoregression& noise() const { return noise_; }

  /// Free run, sensitivities, whitening, normal equations. Keeps the rows for the calls below.
  NormalEquations evaluate(const Eigen::VectorXd& x);

  /// Unwhitened residuals, a segment each, of the last evaluate().
  [[nodiscard]] std::vector<Eigen::VectorXd> residuals() const;

  /// What fitting the shared unknowns took out of the residuals at the last evaluate(), on average: the columns of
  /// J L, L L' = covariance. A generalised least squares fit leaves residuals of covariance R - J C J', R the noise's
  /// own (Seber and Lee, Linear Regression Analysis, 2003, section 3.10), so that a colour read off them alone lacks
  /// power where the record tells most about the unknowns.
  [[nodiscard]] std::vector<Eigen::VectorXd> absorbed(const Eigen::MatrixXd& covariance) const;

  /// H = sum r_j Hessian(r_j) of equation 22 at `x`, as the columns for J, B and C; by symmetry these hold all of H,
  /// because the angle is linear in every other unknown. A forward difference of the analytic Jacobian; `x` must be
  /// the point of the last evaluate().
  [[nodiscard]] Eigen::MatrixXd curvature_columns(const Eigen::VectorXd& x);

  /// `wheel` with the initial states (and offset) that suit it best, a linear problem, and the cost f that they leave.
  struct Completed {
    Eigen::VectorXd x;
    double cost = 0;
  };
  Completed complete(const WheelArm& wheel);

  [[nodiscard]] Unknowns named(const Eigen::VectorXd& x) const;

 private:
  using Rows = Autoregression::Rows;
  const Rows& whitened(std::size_t segment);
  void fill_rows(const Eigen::VectorXd& x, std::size_t segment, Rows& rows);

  std::vector<Segment> segments_;
  int shared_;
  std::size_t samples_ = 0;
  double rounding_power_ = 0;
  Autoregression noise_;
  FreeRunSensitivities run_;
  std::vector<Rows> rows_;   // Jacobian and residual of each segment, plain
  std::vector<Rows> white_;  // and whitened
};

}  // namespace steerid
