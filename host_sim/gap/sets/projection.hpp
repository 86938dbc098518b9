// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is left of whitened lines once all is taken out that the free numbers of a model can explain: the first step of
// a score test, and of a regression beside a model. A number that has a prior explains less: its deviation stands as
// one more line, which only the number itself moves (the augmented least squares of a prior).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/likelihood/whittle.hpp"

namespace steerid::gap {

class Projection {
 public:
  /// `slopes`: by how much the residual moves with each number. `prior_sd`: of the first of them, in their units.
  Projection(const Whittle::Whitened& whitened, const std::vector<Spectrum>& slopes,
             const std::vector<double>& prior_sd = {});

  /// A row a real number of the lines, then one a prior.
  [[nodiscard]] Eigen::VectorXd of(const Whittle::Whitened& whitened, const Spectrum& signal) const;

 private:
  Eigen::Index priors_;
  Eigen::MatrixXd explained_;  // orthonormal columns
};

}  // namespace steerid::gap
