// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/residual_slopes.hpp"

namespace steerid::gap {

std::vector<Spectrum> DifferencedSlopes::at(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  Spectrum here;
  Spectrum moved;
  Response response;
  model_.evaluate(x, here, response);
  std::vector<Spectrum> along;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    along.emplace_back(Spectrum::Zero(here.size()));
    if (!(fitted[i].scale > 0)) continue;
    Eigen::VectorXd beside = x;
    double& value = beside[static_cast<Eigen::Index>(i)];
    const double step = difference_step(fitted[i], value);
    value += step;
    model_.evaluate(beside, moved, response);
    along.back() = (moved - here) / step;
  }
  return along;
}

}  // namespace steerid::gap
