// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/residual_slopes.hpp"

namespace steerid::gap {

std::vector<Spectrum> differences(ResidualModel& model, const Eigen::VectorXd& x, const Spectrum& here,
                                  const std::vector<Fitted>& fitted) {
  std::vector<Spectrum> along(fitted.size(), Spectrum::Zero(here.size()));
  std::vector<std::size_t> numbers;
  std::vector<Eigen::VectorXd> beside;
  std::vector<double> steps;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!(fitted[i].scale > 0)) continue;
    double& value = beside.emplace_back(x)[static_cast<Eigen::Index>(i)];
    steps.push_back(difference_step(fitted[i], value));
    value += steps.back();
    numbers.push_back(i);
  }
  const std::vector<Spectrum> moved = model.residuals_at(beside);
  for (std::size_t k = 0; k < numbers.size(); ++k) along[numbers[k]] = (moved[k] - here) / steps[k];
  return along;
}

std::vector<Spectrum> DifferencedSlopes::at(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  Spectrum here;
  Response response;
  model_.evaluate(x, here, response);
  return differences(model_, x, here, fitted);
}

}  // namespace steerid::gap
