// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel and an arm behind a gap that the wheel only pushes, by Moreau's steps of two bodies (Unilateral contact and
// dry friction in finite freedom dynamics, 1988): they go on at one rate where their free rates would close a gap that
// is closed. It shares no code with the plant and knows no events; first order in its step.
#pragma once

#include "plant/wheel_arm.hpp"

namespace steerid::test {

struct PushedArm {
  WheelArm wheel;  ///< what is the wheel's own; no spring
  WheelArm arm;
  double half_gap_rad = 0;
  double step_s = 0;

  double angle_rad = 0;
  double rate_rad_s = 0;
  double arm_angle_rad = 0;
  double arm_rate_rad_s = 0;
  bool touches = false;            ///< in the last step
  double acceleration_rad_s2 = 0;  ///< of the wheel in it, without the jump where they meet

  /// One step under a torque on the wheel, that of the step's middle.
  void step(double torque_nm) {
    const double middle_rad = angle_rad + rate_rad_s * step_s / 2;
    const double arm_middle_rad = arm_angle_rad + arm_rate_rad_s * step_s / 2;
    const auto free = [&](const WheelArm& body, double rate, double torque) {
      return (body.inertia_kgm2 * rate + step_s * torque) / (body.inertia_kgm2 + step_s * body.damping_nms_per_rad);
    };
    const double arm_torque_nm = -arm.stiffness_nm_per_rad * arm_middle_rad;
    double from = rate_rad_s;
    double rate = free(wheel, rate_rad_s, torque_nm);
    double arm_rate = free(arm, arm_rate_rad_s, arm_torque_nm);
    const double ahead_rad = middle_rad - arm_middle_rad;
    touches = (ahead_rad >= half_gap_rad && rate > arm_rate) || (ahead_rad <= -half_gap_rad && rate < arm_rate);
    if (touches) {
      const WheelArm both{wheel.inertia_kgm2 + arm.inertia_kgm2, wheel.damping_nms_per_rad + arm.damping_nms_per_rad,
                          0};
      from = (wheel.inertia_kgm2 * rate_rad_s + arm.inertia_kgm2 * arm_rate_rad_s) / both.inertia_kgm2;
      rate = arm_rate = free(both, from, torque_nm + arm_torque_nm);
    }
    acceleration_rad_s2 = (rate - from) / step_s;
    rate_rad_s = rate;
    arm_rate_rad_s = arm_rate;
    angle_rad = middle_rad + rate * step_s / 2;
    arm_angle_rad = arm_middle_rad + arm_rate * step_s / 2;
  }
};

}  // namespace steerid::test
