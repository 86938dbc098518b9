// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One record of the paper's experiment, as its instruments would have taken it (section IV.C).
//
//   wheel and arm      J th'' + B th' + C th = T_driver - T_motor + unmeasured torque, C drifting by `stiffness_swing`
//   hands              forces on the rim that make T_driver (experiment/grasp.hpp)
//   transducers        F_x and F_y of each hand and the angle, read 1000 times a second with noise and resolution
//   telemetry          100 Hz: a window of 19 readings (Hann, symmetric: no delay) in front of it, the same on every
//                      channel, so that what the window does to the signals cancels between torque and angle
//   T_driver           the moment of the forces at the measured angle, worked out at 1000 Hz
//
// The motor's torque is the EPS's target, known without error.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "experiment/grasp.hpp"
#include "experiment/tasks.hpp"
#include "log/record.hpp"

namespace steerid {

/// Noise per reading at 1000 Hz, and resolution.
struct Instruments {
  double force_noise_n = 0.3;
  double force_step_n = 0.05;
  double angle_noise_rad = 0.0007;
  double angle_step_rad = 0.0005;

  static Instruments perfect() { return {0, 0, 0, 0}; }
};

struct RecordingSettings {
  TaskKind task = TaskKind::kPassive;
  HandPosition hands = HandPosition::kRight3;
  WheelArm arm;
  double duration_s = 80;
  double probe_rms_nm = 0;        ///< small multisine from the EPS on top of the task
  double stiffness_swing = 0;     ///< C drifts by this share, up and down, while the driver's co-contraction does
  double unmeasured_percent = 0;  ///< of the applied torque's rms
  Instruments instruments;
  std::uint64_t seed = 1;
};

struct Recording {
  Record record;                                 ///< T_driver is the reconstructed moment
  std::array<std::vector<GraspForce>, 2> force;  ///< measured, one a row; the second is empty for one hand
  std::vector<double> driver_torque_nm;          ///< the true one
  std::vector<double> angle_rad;                 ///< the true one
};

/// Throws std::invalid_argument for a negative noise or a duration below a second.
[[nodiscard]] Recording make_recording(const RecordingSettings& settings);

}  // namespace steerid
