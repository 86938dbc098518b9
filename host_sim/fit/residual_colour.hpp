// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The colour of what a fit leaves: the noise that goes through the wheel (fit/wheel_noise.hpp), or a free
// autoregression where that explains the residual beyond doubt better.
//
// The wheel's noise has two to four numbers, a free autoregression up to thirty. With few numbers a stated standard
// deviation is one; but a residual that holds more than noise (friction, a compliance, a torque that is off)
// has a colour of its own, and there the free one stays. It is taken when Akaike's criterion leaves the wheel's noise
// no support.
#pragma once

#include <Eigen/Core>
#include <span>

#include "fit/autoregression.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

/// The longest free autoregression and the wheel noise's memory, in samples.
struct ColourMemory {
  int free = 0;
  int wheel = 0;
};

/// `absorbed` is what the fit took from the residuals (OutputError::absorbed()).
[[nodiscard]] Autoregression residual_colour(std::span<const Eigen::VectorXd> residuals,
                                             std::span<const Eigen::VectorXd> absorbed, const WheelArm& wheel,
                                             double period_s, const ColourMemory& memory);

}  // namespace steerid
