// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/drive_task.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

constexpr double kLaneKeepingCornerHz = 0.3;

/// Streams of chance, apart from those of the sensors and of the paper's tasks.
enum Stream : std::uint64_t { kManoeuvre = 200, kLaneKeeping = 201, kRoad = 202 };

Cubic straight(double from, double to) { return {from, (to - from) / kTickS, 0, 0}; }

}  // namespace

double ArmChange::gone(double time_s) const {
  const double since_s = time_s - at_s;
  if (course == ArmCourse::kConstant || since_s <= 0) return 0;
  const double share = since_s / length_s;
  switch (course) {
    case ArmCourse::kConstant:
    case ArmCourse::kStep:
      return 1;
    case ArmCourse::kRamp:
      return std::min(share, 1.0);
    case ArmCourse::kThereAndBack:
      return std::max(0.0, share < 1 ? share : 2 - share);
    case ArmCourse::kSwing:
      break;
  }
  return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * share);
}

double ArmChange::stiffness_at(double time_s, double usual_nm_per_rad) const {
  const double way = gone(time_s);
  if (course == ArmCourse::kSwing) return usual_nm_per_rad * std::pow(stiffness_nm_per_rad / usual_nm_per_rad, way);
  if (way == 1) return stiffness_nm_per_rad;
  return usual_nm_per_rad + way * (stiffness_nm_per_rad - usual_nm_per_rad);
}

WheelArm ArmChange::arm_at(double time_s, const WheelArm& usual, const WheelArm& wheel) const {
  const double way = gone(time_s);
  const double stiffness = stiffness_at(time_s, usual.stiffness_nm_per_rad);
  const auto between = [&](double from, double to) { return from + way * (to - from); };
  const double stiffer = usual.stiffness_nm_per_rad > 0 ? stiffness / usual.stiffness_nm_per_rad : 1;
  return {between(usual.inertia_kgm2, inertia_kgm2.value_or(usual.inertia_kgm2)),
          damping_nms_per_rad ? between(usual.damping_nms_per_rad, *damping_nms_per_rad)
                              : wheel.damping_nms_per_rad +
                                    (usual.damping_nms_per_rad - wheel.damping_nms_per_rad) * std::sqrt(stiffer),
          stiffness};
}

DriveTask::DriveTask(const DriveSettings& settings, const Column& column)
    : settings_(settings),
      wheel_{column.wheel_inertia_kgm2, column.wheel_damping_nms_per_rad, 0},
      manoeuvre_(settings.manoeuvre, settings.seed, kManoeuvre),
      lane_keeping_({.rms = settings.steering_rad, .corner_hz = kLaneKeepingCornerHz}, settings.seed, kLaneKeeping),
      road_({.rms = column.road_rms_nm, .corner_hz = column.road_corner_hz}, settings.seed, kRoad),
      probe_(settings.probe) {
  if (settings.arm.inertia_kgm2 <= wheel_.inertia_kgm2 ||
      settings.arm.damping_nms_per_rad < wheel_.damping_nms_per_rad) {
    throw BadInput(fmt::format(
        "expected arm and wheel together heavier and more damped than the column's wheel, J {:g} "
        "kg m2 and B {:g} Nms/rad, found J {:g} and B {:g}; give a larger arm or a lighter wheel",
        wheel_.inertia_kgm2, wheel_.damping_nms_per_rad, settings.arm.inertia_kgm2, settings.arm.damping_nms_per_rad));
  }
  now_ = next_points();
}

/// How much of the arm is on the wheel: 1 held, 0 released.
SignalPoint DriveTask::hold(double time_s) {
  const auto& releases = settings_.releases;
  while (release_ < releases.size() &&
         time_s > releases[release_].at_s + releases[release_].length_s + DriveSettings::kReturnS) {
    ++release_;
  }
  if (release_ == releases.size()) return {1, 0};
  const Release& here = releases[release_];
  const SignalPoint left = smooth_rise((time_s - here.at_s) / DriveSettings::kLeaveS);
  const SignalPoint back = smooth_rise((time_s - here.at_s - here.length_s) / DriveSettings::kReturnS);
  return {1 - left.value + back.value, -left.slope / DriveSettings::kLeaveS + back.slope / DriveSettings::kReturnS};
}

DriveTask::Points DriveTask::next_points() {
  const double time_s = static_cast<double>(tick_++) * kTickS;
  const double usual_nm_per_rad = settings_.arm.stiffness_nm_per_rad;
  const WheelArm arm = settings_.change.arm_at(time_s, settings_.arm, wheel_);
  const double stiffness = arm.stiffness_nm_per_rad;
  const double stiffness_slope =
      (settings_.change.stiffness_at(time_s + kTickS, usual_nm_per_rad) - stiffness) / kTickS;
  const SignalPoint held = hold(time_s);
  const SignalPoint angle = manoeuvre_.next() + lane_keeping_.next();
  Points points;
  points.truth.arm = {wheel_.inertia_kgm2 + held.value * (arm.inertia_kgm2 - wheel_.inertia_kgm2),
                      wheel_.damping_nms_per_rad + held.value * (arm.damping_nms_per_rad - wheel_.damping_nms_per_rad),
                      held.value * stiffness};
  points.voluntary = {held.value * stiffness * angle.value, held.slope * stiffness * angle.value +
                                                                held.value * stiffness_slope * angle.value +
                                                                held.value * stiffness * angle.slope};
  points.truth.torque_driver_nm = points.voluntary.value;
  points.probe = probe_.next();
  points.road = road_.next();
  return points;
}

DriveTick DriveTask::next() {
  const Points from = now_;
  now_ = next_points();
  const WheelArm& arm = from.truth.arm;
  const WheelArm& next = now_.truth.arm;
  return {.inputs = {.voluntary_nm = between(from.voluntary, now_.voluntary, kTickS),
                     .probe_nm = {},
                     .road_nm = between(from.road, now_.road, kTickS),
                     .inertia_kgm2 = straight(arm.inertia_kgm2, next.inertia_kgm2),
                     .damping_nms = straight(arm.damping_nms_per_rad, next.damping_nms_per_rad),
                     .stiffness_nm = straight(arm.stiffness_nm_per_rad, next.stiffness_nm_per_rad)},
          .probe_asked_nm = between(from.probe, now_.probe, kTickS),
          .truth = from.truth};
}

}  // namespace steerid
