// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What can be wrong with a wheel, as the blind generator sees it: an element takes part in the torque balance, in what
// the sensors see before their filters, and in what is written down after them.
//
// An element with corners has modes. In a mode it is smooth, and its guard() is positive; the simulation stops where
// the guard vanishes, found as a root on the integrator's continuous extension, calls cross(), and goes on in the next
// mode. What happens at a known time is announced by next_time_s() and done by at_time(). Elements act in the order in
// which they are listed.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "blind/draw.hpp"

namespace steerid::blind {

/// Time counts from the record's first sample; the drive begins before it.
struct Instant {
  double time_s = 0;
  double angle_rad = 0;
  double rate_rad_s = 0;
};

/// inertia th'' = driver - motor + torque - damping th' - stiffness spring_angle
struct Balance {
  double inertia_kgm2 = 0;
  double damping_nms_per_rad = 0;
  double stiffness_nm_per_rad = 0;
  double spring_angle_rad = 0;
  double driver_nm = 0;
  double motor_nm = 0;
  double torque_nm = 0;
};

/// What the three sensors are shown, before their anti-alias filters.
struct Shown {
  double driver_nm = 0;
  double motor_nm = 0;
  double angle_rad = 0;
};

/// What was written down, one value a sample.
struct Columns {
  std::vector<double> driver_nm;
  std::vector<double> motor_nm;
  std::vector<double> angle_rad;
};

class Element {
 public:
  virtual ~Element() = default;

  /// Continuous states of its own, zero unless start() sets them.
  [[nodiscard]] virtual std::size_t states() const { return 0; }
  virtual void start(const Instant& /*now*/, std::span<double> /*own*/) {}

  virtual void act(const Instant& /*now*/, std::span<const double> /*own*/, std::span<double> /*slope*/,
                   Balance& /*balance*/) const {}
  virtual void show(const Instant& /*now*/, std::span<const double> /*own*/, std::span<double> /*slope*/,
                    Shown& /*shown*/) const {}

  /// Positive while the mode holds.
  [[nodiscard]] virtual double guard(const Instant& /*now*/, std::span<const double> /*own*/) const { return 1; }
  /// To the next mode; may set its own states.
  virtual void cross(const Instant& /*now*/, std::span<double> /*own*/) {}

  /// The first time after `time_s` at which something jumps.
  [[nodiscard]] virtual double next_time_s(double /*time_s*/) const { return std::numeric_limits<double>::infinity(); }
  virtual void at_time(double /*time_s*/) {}

  /// After every accepted step, and at the start.
  virtual void passed(const Instant& /*now*/, double /*acceleration_rad_s2*/) {}

  /// How late the angle, or with a negative sign the torques, are written down; `time_s` of the stamp.
  [[nodiscard]] virtual double late_s(double /*time_s*/) const { return 0; }
  /// Before the sensors' noise.
  virtual void write(Columns& /*columns*/) const {}
  /// After noise and resolution.
  virtual void convert(Columns& /*columns*/, Draw& /*draw*/) const {}
};

}  // namespace steerid::blind
