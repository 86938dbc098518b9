// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the floor leaves of the angle: noise torques behind a wheel's response, and the angle's own noise.
#pragma once

#include <functional>
#include <vector>

#include "gap/likelihood/noise_floor.hpp"
#include "plant/effects/effect.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid::gap {

/// |H|^2 of a linear wheel; one without a spring is held by half its inertia, so that it has a response at rest.
[[nodiscard]] std::function<double(double)> held_gain(WheelArm wheel);

/// |H|^2 of a wheel with those of the effects that change its response.
[[nodiscard]] std::function<double(double)> gain_with(const WheelArm& wheel, const std::vector<Effect>& effects);

/// rms of the angle that the floor leaves behind a response of this |H|^2.
[[nodiscard]] double floor_rms_rad(const NoiseFloor& floor, const std::function<double(double)>& gain,
                                   double quantum_rad);

}  // namespace steerid::gap
