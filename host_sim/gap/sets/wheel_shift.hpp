// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How far a fit has moved J, B and C from what the simulation had.
#pragma once

#include "gap/likelihood/whittle.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

/// How far J, B and C are from the simulation's: the sum of what their priors cost (gap/likelihood/prior.hpp), where
/// they are up to three deviations nearer to the simulation's than the fit has them: a number that the record hardly
/// tells is not far from anything. Simulations are off by up to 8 %, which is 3 for all of them.
[[nodiscard]] double shift_at_least(const WheelArm& sim, const Whittle::Fit& fit);

/// Further from the simulation's J, B and C make up for something: each off by a tenth is a shift of 4. Simulations
/// that are 8 % off in all three have 3.
inline constexpr double kOutOfPlace = 4;

}  // namespace steerid::gap
