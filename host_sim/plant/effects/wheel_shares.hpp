// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which parts of J and B are the wheel's own, where an effect parts the arm from the wheel.
#pragma once

#include "plant/effects/effect.hpp"

namespace steerid::effect {

/// Up to `most`, which is less than one where the arm keeps a mass of its own.
constexpr Parameter wheel_inertia_share(double most) {
  return {"wheel_inertia_share", 0.3, 0.05, most, 0.05, "part of J that is the wheel's own", {.mean = 0.28, .sd = 0.1}};
}

inline constexpr Parameter kWheelDampingShare{
    "wheel_damping_share", 0.05, 0.0, 1.0, 0.02, "part of B that is the wheel's own", {.mean = 0.06, .sd = 0.04}};

}  // namespace steerid::effect
