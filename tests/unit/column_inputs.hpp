// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What acts on a column over a tick of a test, with an arm that stays as it is.
#pragma once

#include "plant/column_plant.hpp"
#include "plant/wheel_arm.hpp"
#include "plant_drive.hpp"

namespace steerid::test {

inline constexpr WheelArm kArm{0.11, 1.5, 22.7};

inline ColumnInputs inputs(const WheelArm& arm, const Torque& voluntary, const Torque& probe, const Torque& road,
                           double t, double h = kTickS) {
  return {voluntary.piece(t, h),
          probe.piece(t, h),
          road.piece(t, h),
          {arm.inertia_kgm2, 0, 0, 0},
          {arm.damping_nms_per_rad, 0, 0, 0},
          {arm.stiffness_nm_per_rad, 0, 0, 0}};
}

}  // namespace steerid::test
