// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A model around a point, straightened: its residual moves along the derivatives that it has there, and torques can
// stand beside it, each with a factor of its own. What they gain is then a fit of a linear model
// (gap/likelihood/whittle.hpp) that simulates nothing.
//
//   residual(x + d, c) = residual(x) + sum d_i d(residual)/dx_i - H sum c_j T_j
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/likelihood/whittle.hpp"

namespace steerid::gap {

class StraightenedModel final : public ResidualModel {
 public:
  /// Around x, whose numbers are `fitted`; `slopes`: by how much the residual moves there with each of them.
  StraightenedModel(ResidualModel& model, Eigen::VectorXd x, std::vector<Fitted> fitted, std::vector<Spectrum> slopes);

  /// The torques that stand beside the model, instead of those before.
  void stand_beside(const std::vector<Spectrum>& torques);

  /// x, and nothing of the torques.
  [[nodiscard]] Eigen::VectorXd start() const;
  /// The model's numbers, and the torques' factors, in units in which one is as large as what the model leaves.
  [[nodiscard]] std::vector<Fitted> fitted() const;
  /// What the model leaves at x.
  [[nodiscard]] const Spectrum& residual() const { return residual_; }
  /// From a torque to the recorded angle.
  [[nodiscard]] const Spectrum& gain() const { return response_.gain; }

  void evaluate(const Eigen::VectorXd& at, Spectrum& residual, Response& response) override;

 private:
  Eigen::VectorXd x_;
  std::vector<Fitted> fitted_;
  Spectrum residual_;
  Response response_;
  std::vector<Spectrum> along_;  // of x's numbers, then of the torques
};

}  // namespace steerid::gap
