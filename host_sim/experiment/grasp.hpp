// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The forces of the hands on the rim, and the moment that they make: section IV.C of Lv et al. 2018.
//
// Axes: x to the driver's right, y forward, in the plane of the wheel, fixed to the vehicle as the paper's figure 3 has
// them; the angle is positive counter-clockwise as the driver sees it. A hand that took hold at the clock angle phi0
// (3 o'clock: 0, 12 o'clock: 90 degrees) is at phi = phi0 + th when the wheel has turned by th, and
//
//   F = F_t (-sin phi, cos phi) - F_r (cos phi, sin phi)          F_t along the rim, F_r towards the hub
//   M_z = sum over the hands of R (cos phi F_y - sin phi F_x) = R sum F_t
//
// so that the pull towards the hub makes no moment. At 3 o'clock and th = 0 that is the paper's M_z = R F_y. With the
// wheel turned the force in y alone no longer is the moment: one needs both components and the angle.
//
// How the forces come about: the tangential forces add up to the driver's torque, shared between two hands with a share
// that wanders around one half; two hands also push a little against each other; and each hand holds on with a pull
// towards the hub that grows with its own tangential force. What the driver cannot know, or does not care for, is
// smooth noise with a corner of 0.3 Hz.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "experiment/hand_positions.hpp"
#include "experiment/smooth_noise.hpp"

namespace steerid {

inline constexpr double kWheelRadius_m = 0.19;

/// Clock angles of the hands at rest, rad counter-clockwise from 3 o'clock: one or two.
[[nodiscard]] std::span<const double> grip_angles(HandPosition hands);

struct GraspForce {
  double x_n = 0;
  double y_n = 0;
};

/// M_z of `forces`, one a hand, with the wheel turned by `angle_rad`.
[[nodiscard]] double grasp_moment_nm(HandPosition hands, std::span<const GraspForce> forces, double angle_rad);

/// The hands of one driver in one drive.
class Grasp {
 public:
  Grasp(HandPosition hands, std::uint64_t seed, std::uint64_t first_stream);

  /// On to the next tick; call before the first at().
  void next();

  /// One force a hand, `tau_s` into the tick, for the driver's torque and the wheel's angle at that instant.
  [[nodiscard]] std::array<GraspForce, 2> at(double tau_s, double torque_nm, double angle_rad) const;

  [[nodiscard]] std::size_t hands() const { return grips_.size(); }

 private:
  /// A smooth signal over the present tick.
  struct Course {
    SmoothNoise noise;
    SignalPoint to;
    Cubic piece;
    void next();
  };

  std::span<const double> grips_;
  Course share_;                ///< of the first hand, about its mean
  Course opposed_n_;            ///< what two hands push against each other
  std::array<Course, 2> pull_;  ///< relative to its mean
};

}  // namespace steerid
