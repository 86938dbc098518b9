// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One Gauss-Newton run on an output-error problem: steps, step lengths and the reason to stop are those of
// fit/gauss_newton.hpp.
#pragma once

#include <Eigen/Core>

#include "fit/gauss_newton.hpp"
#include "fit/output_error.hpp"

namespace steerid {

/// What a run leaves behind.
struct Iteration {
  Eigen::VectorXd x;
  NormalEquations equations;
  StopReason stop = StopReason::kIterationLimit;
  int steps = 0;
  double gradient = 0;  ///< largest cosine between the residual and a column of the Jacobian
  bool curvature_ok = true;
};

/// From `start`, which is complete (OutputError::complete()). The first `fixed` unknowns (1: the inertia) stay as they
/// are. The problem keeps the rows of where the run ends.
[[nodiscard]] Iteration gauss_newton(OutputError& problem, Eigen::VectorXd start, int max_steps, double tolerance,
                                     int fixed = 0);

}  // namespace steerid
