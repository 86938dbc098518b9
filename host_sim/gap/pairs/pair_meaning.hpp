// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether two effects mean what their names say beside each other. Two together can be the first terms of something
// that neither is, and reach the floor as such:
//   undone     two torques that are large only against each other: their sum is no effect of either
//   filter     a grip beside a delay, a lag or a reflex: two responses that come close to any other one
//   friction   a drag beside dry friction that is smaller than what the linear damping moved by to make room for it:
//              constant, linear and quadratic in rate they bend as Stribeck's friction does
#pragma once

#include "gap/model/spectral_model.hpp"
#include "plant/effects/effect.hpp"
#include "plant/wheel_arm.hpp"

namespace steerid {

/// `found`: J, B, C that were fitted with the two, in place of the simulation's.
[[nodiscard]] bool stand_together(const SpectralRecord& record, const WheelArm& sim, const WheelArm& found,
                                  const Effect& one, const Effect& other);

}  // namespace steerid
