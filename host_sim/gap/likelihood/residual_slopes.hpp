// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How what a model leaves moves with its numbers: what a fit goes along (gap/likelihood/whittle.hpp).
#pragma once

#include <vector>

#include "gap/likelihood/whittle.hpp"

namespace steerid::gap {

class ResidualSlopes {
 public:
  virtual ~ResidualSlopes() = default;
  /// One spectrum a number of x: by how much the residual moves when that moves by one. Zero for a number that is a
  /// choice (Fitted::scale of 0).
  virtual std::vector<Spectrum> at(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) = 0;
};

/// By differences to `here`, the residual at x.
[[nodiscard]] std::vector<Spectrum> differences(ResidualModel& model, const Eigen::VectorXd& x, const Spectrum& here,
                                                const std::vector<Fitted>& fitted);

/// Those of a model, by differences: of the one that is fitted, or of a cheaper one. As many evaluations as numbers,
/// and one.
class DifferencedSlopes final : public ResidualSlopes {
 public:
  explicit DifferencedSlopes(ResidualModel& model) : model_(model) {}
  std::vector<Spectrum> at(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) override;

 private:
  ResidualModel& model_;
};

}  // namespace steerid::gap
