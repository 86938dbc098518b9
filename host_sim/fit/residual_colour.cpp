// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/residual_colour.hpp"

#include <optional>
#include <utility>

#include "fit/akaike.hpp"
#include "fit/wheel_noise.hpp"

namespace steerid {

Autoregression residual_colour(std::span<const Eigen::VectorXd> residuals, std::span<const Eigen::VectorXd> absorbed,
                               const WheelArm& wheel, double period_s, const ColourMemory& memory) {
  Autoregression free = Autoregression::fit(residuals, memory.free);
  std::optional<Autoregression> through =
      wheel_noise(LaggedProducts(residuals, absorbed, memory.wheel), wheel, period_s);
  if (!through) return free;
  double samples = 0;
  for (const Eigen::VectorXd& one : residuals) samples += static_cast<double>(one.size());
  const auto criterion = [&](const Autoregression& model) {
    return corrected_akaike(model.misfit(residuals), samples, model.numbers() + 1);
  };
  return criterion(free) + kNoSupport < criterion(*through) ? std::move(free) : *std::move(through);
}

}  // namespace steerid
