// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The simulated back end of the port: wheel, driver, EPS and sensors behind the same calls that the microcontroller
// answers. The firmware's loop runs on it as it is.
//
// wait_tick() moves simulated time on by kTickPeriodUs and returns kEndOfStream once duration/period ticks have been.
// Tick k samples at k * kTickPeriodUs, the first one at 0; the wheel starts at rest at angle 0. Time is integer
// microseconds and there is one thread, so a scenario repeats bit for bit.
//
// Beside each measured row the truth is kept: what acted and where the wheel was at the very instant of sampling, free
// of every defect. Rows of lost messages are in neither.
//
// Effects act where their files say: in the plant; on the channels between lag and delay of the sensors and their
// noise; or, converters, after it. See sensors/sensor_channel.hpp for the sensors' own defects and for Nyquist.
//
// Cost on the linear wheel: see tests/bench. Nothing allocates after the constructor.
#pragma once

#include <cstdint>
#include <vector>

#include "backend/probe_path.hpp"
#include "experiment/tasks.hpp"
#include "log/record.hpp"
#include "plant/effects/effect.hpp"
#include "plant/plant.hpp"
#include "plant/recorder.hpp"
#include "port/port.hpp"
#include "sensors/sensor_suite.hpp"

namespace steerid {

/// Everything that determines a simulated drive.
struct Scenario {
  WheelArm wheel;
  std::vector<Effect> effects{};
  TaskSettings task;
  SensorDefects sensors = SensorDefects::realistic();
  double duration_s = 60.0;
  bool grant_probe_requests = false;  ///< whether the EPS adds what request_probe_torque() asks for
};

/// Largest probe torque that the EPS grants: requests beyond it are refused with kOutOfRange.
inline constexpr std::int32_t kLargestProbeMnm = 5'000;

/// What a simulated drive left behind; rows of `measured`, `truth` and `unmeasured_torque_nm` belong together.
struct SimulatedDrive {
  Record measured;
  Record truth;
  std::vector<double> unmeasured_torque_nm;
  std::vector<Estimate> estimates;  ///< in the order of publication

  void reserve(std::size_t ticks);
};

class SimulatedHal {
 public:
  /// Without `drive` nothing is kept, for runs of any length. It must outlive this object. Throws BadInput when the
  /// effects contradict each other.
  explicit SimulatedHal(const Scenario& scenario, SimulatedDrive* drive = nullptr);

  Status wait_tick();
  Status read_sample(Sample& sample);
  Status publish(const Estimate& estimate);
  Status request_probe_torque(std::int32_t torque_mnm);
  void set_valid(bool level) { valid_ = level; }
  void set_fault(bool level) { fault_ = level; }
  void kick_watchdog() { ++watchdog_kicks_; }

  [[nodiscard]] const Estimate& estimate() const { return estimate_; }
  [[nodiscard]] bool valid() const { return valid_; }
  [[nodiscard]] bool fault() const { return fault_; }
  [[nodiscard]] std::uint64_t watchdog_kicks() const { return watchdog_kicks_; }

 private:
  [[nodiscard]] TickSignals move_wheel(const TaskTorques& torques);
  [[nodiscard]] Measurement measure(const Analogue& analogue, double rate_rad_s);
  void keep(const Measurement& measured, const Analogue& analogue, const TickSignals& truth, const Cubic& unmeasured);

  Task task_;
  ProbePath probe_path_;
  bool grant_probe_requests_;
  Plant plant_;
  Recorder recorder_;
  SensorSuite sensors_;
  SimulatedDrive* drive_;
  std::int64_t ticks_left_;
  Sample sample_;
  bool fresh_ = false;
  std::uint16_t sequence_ = 0;
  Estimate estimate_;
  bool valid_ = false;
  bool fault_ = false;
  std::uint64_t watchdog_kicks_ = 0;
};

static_assert(Hal<SimulatedHal>);

}  // namespace steerid
