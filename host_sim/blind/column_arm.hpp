// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The arm of a drive by column_drive.hpp, and how it changes: one ArmCourse each.
#pragma once

#include "blind/column_drive.hpp"
#include "blind/draw.hpp"
#include "blind/signal.hpp"

namespace steerid::blind {

/// Arm and wheel over time, from `lead_s` before the drive until `lead_s` after it.
struct ColumnArm {
  Signal inertia, damping, stiffness;  ///< kg m2, Nms/rad, Nm/rad
  double usual_stiffness = 0;          ///< without its changes

  /// Of the wheel without hands: kg m2 and Nms/rad.
  struct Wheel {
    double inertia = 0;
    double damping = 0;
  };
  ColumnArm(const ColumnRequest& request, const Wheel& wheel, double lead_s, Draw draw);
};

}  // namespace steerid::blind
