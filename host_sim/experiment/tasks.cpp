// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "experiment/tasks.hpp"

#include <cmath>

namespace steerid {
namespace {

constexpr double kTriangleNm = 5.0;            // 10 Nm peak to peak
constexpr std::int64_t kTriangleTicks = 4000;  // 0.025 Hz
constexpr double kAssistShare = 0.1;
constexpr double kUnmeasuredCornerHz = 0.3;

enum Stream : std::uint64_t { kUnmeasured = 100, kHolding = 110, kSteering = 120 };

double applied_rms_nm(const TaskSettings& settings, const SteeringDriver& steering) {
  const double probe = settings.probe.rms_nm;
  switch (settings.kind) {
    case TaskKind::kPassive:
      return std::hypot(kTriangleNm / std::sqrt(3.0), probe);
    case TaskKind::kActive:
      return std::hypot(steering.nominal_rms_nm(), probe);
    case TaskKind::kProbe:
      break;
  }
  return probe;
}

}  // namespace

TaskSettings task_settings(TaskKind kind, HandPosition hands, std::uint64_t seed) {
  TaskSettings settings{.kind = kind, .arm = nominal_arm(kind, hands), .seed = seed};
  if (kind != TaskKind::kProbe) settings.probe.rms_nm = 0.0;
  return settings;
}

Task::Task(const TaskSettings& settings)
    : kind_(settings.kind),
      eps_(settings.eps),
      triangle_(kTriangleNm, kTriangleTicks),
      probe_(settings.probe),
      holding_(settings.seed, kHolding),
      steering_({}, settings.arm, settings.seed, kSteering),
      applied_rms_nm_(steerid::applied_rms_nm(settings, steering_)),
      unmeasured_({.rms = settings.unmeasured_percent / 100.0 * applied_rms_nm_, .corner_hz = kUnmeasuredCornerHz},
                  settings.seed, kUnmeasured) {
  now_ = next_points();
}

Task::Points Task::next_points() {
  Points points;
  points.unmeasured = unmeasured_.next();
  points.motor = probe_.next();
  switch (kind_) {
    case TaskKind::kPassive:
      points.driver = holding_.next();
      points.motor += triangle_.next();
      break;
    case TaskKind::kActive: {
      // The driver and the assistance together are what the wheel needs.
      points.driver = 1.0 / (1.0 + kAssistShare) * steering_.next();
      points.motor += -kAssistShare * points.driver;
      break;
    }
    case TaskKind::kProbe:
      points.driver = holding_.next();
      break;
  }
  return points;
}

TaskTorques Task::next() {
  const Points from = now_;
  now_ = next_points();
  return {
      .driver = between(from.driver, now_.driver, kTickS),
      .motor = eps_ == EpsTorque::kHeld ? Cubic{from.motor.value, 0, 0, 0} : between(from.motor, now_.motor, kTickS),
      .unmeasured = between(from.unmeasured, now_.unmeasured, kTickS)};
}

}  // namespace steerid
