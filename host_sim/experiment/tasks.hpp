// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The paper's two steering tasks and a probe, as torques over time.
//
// | task    | EPS motor                                               | driver                                    |
// | passive | triangle of 10 Nm peak to peak, 0.025 Hz (+ a probe)    | holds: restlessness and tremor, 0.15 Nm   |
// | active  | assists with 10 % of the driver's torque (+ a probe)    | steers: about 1 rad (60 degrees), 0.25 Hz |
// | probe   | multisine, 0.2 to 5 Hz, 1.5 Nm rms                      | holds                                     |
//
// What lies between two ticks is part of the task, not of who reads it:
//   kSmooth  torques are smooth signals: values and slopes at the ticks are those of the formulas, joined by cubics.
//            Nothing lies above 20 Hz, so 100 Hz samples say all there is, and no delay is invented.
//   kHeld    the EPS holds its target torque over each tick: what a sample says at t acts from t to the next tick.
//            To a reader who takes the samples for a smooth signal this is a delay of half a tick.
// The driver's torque is always smooth.
//
// The motor's torque is subtracted in the model: an assistance has the opposite sign of the driver's torque.
//
// Unmeasured torque: every driver adds some that no sensor sees, slow (corner at 0.3 Hz, 12 dB an octave above: 1 % of
// its power lies beyond 1 Hz) and coloured. Its rms is given relative to that of the torque the task applies.
#pragma once

#include <cstdint>
#include <optional>

#include "experiment/hand_positions.hpp"
#include "experiment/multisine.hpp"
#include "experiment/triangle.hpp"
#include "experiment/virtual_driver.hpp"

namespace steerid {

enum class EpsTorque { kSmooth, kHeld };

struct TaskSettings {
  TaskKind kind = TaskKind::kProbe;
  WheelArm arm{};  ///< what the steering driver takes the arm to be
  EpsTorque eps = EpsTorque::kSmooth;
  MultisineSettings probe{};      ///< rms 0: no probe
  double unmeasured_percent = 0;  ///< of the applied torque's rms
  std::uint64_t seed = 1;
};

/// A task with the probe that belongs to it: 1.5 Nm rms for `probe`, none otherwise.
TaskSettings task_settings(TaskKind kind, HandPosition hands, std::uint64_t seed);

/// The torques over one tick.
struct TaskTorques {
  Cubic driver;
  Cubic motor;
  Cubic unmeasured;  ///< acts on the wheel as the driver's does; no sensor sees it
};

class Task {
 public:
  explicit Task(const TaskSettings& settings);

  /// The next tick's torques; the first one starts at time 0.
  TaskTorques next();

  /// rms of T_driver - T_motor as the task means it, without what the driver adds by chance.
  [[nodiscard]] double applied_rms_nm() const { return applied_rms_nm_; }

 private:
  struct Points {
    SignalPoint driver;
    SignalPoint motor;
    SignalPoint unmeasured;
  };
  [[nodiscard]] Points next_points();

  TaskKind kind_;
  EpsTorque eps_;
  Triangle triangle_;
  Multisine probe_;
  HoldingDriver holding_;
  SteeringDriver steering_;
  double applied_rms_nm_;
  SmoothNoise unmeasured_;
  Points now_;
};

}  // namespace steerid
