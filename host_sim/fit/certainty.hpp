// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a fitted answer is worth: its covariance, which parameters it states, what the record excites, and how
// strongly the problem bends.
//
// Everything is in terms of the whitened Jacobian at the solution, with the initial states eliminated.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "fit/output_error.hpp"
#include "plant/wheel_arm.hpp"
#include "port/estimate.hpp"

namespace steerid {

/// Deviations of a normal distribution to either side that hold 95 % of it.
inline constexpr double kNormal95 = 1.959964;

struct FittedParameter {
  double value = 0;
  double sd = std::numeric_limits<double>::infinity();  ///< one standard deviation; infinite when not excited at all
  ParameterState state = ParameterState::kNotExcited;   ///< kValid or kNotExcited
  std::optional<double> at_most = {};  ///< when not identified: the largest value that the record allows, three sd
  bool model_misfit = false;           ///< outside its physical range by more than 1.96 sd: the model lacks something
};

/// What the record can show, from the whitened Jacobian with its columns scaled to relative changes of J, B and C and
/// the initial states eliminated. Singular values are inverse relative standard deviations: the smallest one is
/// gamma of equation 17, and a direction counts towards the rank when its sd is at most valid_relative_sd.
struct Excitation {
  int rank = 0;  ///< of J, B, C: 3 when all directions are seen
  double smallest_singular_value = 0;
  double condition_number = std::numeric_limits<double>::infinity();
  Eigen::Vector3d unexcited_direction =
      Eigen::Vector3d::Zero();  ///< unit vector of relative changes (J, B, C) seen worst
};

/// Over the noise's variance, of a direction without information: large enough to be called unexcited, small enough to
/// square.
inline constexpr double kUnexcited = 1e30;

/// Covariance of the shared unknowns from their information and the noise's variance; a direction without information
/// has `unexcited` times that.
[[nodiscard]] Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information, double variance,
                                            double unexcited = kUnexcited);

/// kValid when the standard deviation is at most `valid_relative_sd` of the value and the value is positive, or may be
/// negative; see FittedParameter.
[[nodiscard]] FittedParameter judged(double value, double variance, bool may_be_negative, double valid_relative_sd);

/// From the covariance of J, B, C (first three rows). A direction is seen when its relative sd is at most `seen_sd`.
[[nodiscard]] Excitation excitation(const Eigen::MatrixXd& covariance, const WheelArm& wheel, double seen_sd);

/// ||[J'J]^-1 H|| of equation 27 in the norm of J'J: the largest |eigenvalue|, by power iteration. `columns` are those
/// of H for J, B and C (OutputError::curvature_columns()).
[[nodiscard]] double convergence_factor(const NormalEquations& equations, const Eigen::MatrixXd& columns);

}  // namespace steerid
