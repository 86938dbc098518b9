// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The simulated back end of a whole column: arm, torsion bar, column, motor and the sensors of a car behind the same
// calls that the microcontroller answers.
//
// Ticks, time and sampling are those of SimulatedHal (backend/simulated.hpp). The sample has angle, torque_bar,
// torque_motor, torque_rim and probe; the driver's voluntary torque is in no sample, only in the truth beside it.
//
// The probe: the multisine of the settings and, if the EPS grants them, the torques that the task requests, smoothly
// through the requests (backend/probe_path.hpp). The channel `probe` says what the EPS was asked for; the motor
// delivers it by the column's probe_gain, later by its probe_delay_s, and together with the assist no more than its
// limit.
//
// Nothing allocates after the constructor, the rows kept in ColumnDrive apart.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "backend/probe_path.hpp"
#include "experiment/drive_task.hpp"
#include "log/record.hpp"
#include "plant/column_plant.hpp"
#include "port/port.hpp"
#include "sensors/column_sensors.hpp"

namespace steerid {

/// Everything that determines a simulated drive of a whole column.
struct ColumnScenario {
  Column column{};
  DriveSettings drive{};
  ColumnSensorDefects sensors = ColumnSensorDefects::realistic();
  double duration_s = 60.0;
  bool grant_probe_requests = false;  ///< whether the EPS adds what request_probe_torque() asks for
};

/// What a simulated drive left behind; a row of `arm` and of `undisturbed` belongs to each of `measured`.
struct ColumnDrive {
  Record measured;
  Record undisturbed;             ///< the same channels, free of every defect, at the instants of sampling
  std::vector<DriveTruth> truth;  ///< what no sensor sees, at those instants
  std::vector<Estimate> estimates;
};

class SimulatedColumnHal {
 public:
  /// Without `drive` nothing is kept. It must outlive this object. Throws BadInput as DriveTask does.
  explicit SimulatedColumnHal(const ColumnScenario& scenario, ColumnDrive* drive = nullptr);

  Status wait_tick();
  Status read_sample(Sample& sample);
  Status publish(const Estimate& estimate);
  Status request_probe_torque(std::int32_t torque_mnm);
  void set_valid(bool level) { valid_ = level; }
  void set_fault(bool level) { fault_ = level; }
  void kick_watchdog() {}

  [[nodiscard]] const Estimate& estimate() const { return estimate_; }
  [[nodiscard]] bool valid() const { return valid_; }
  [[nodiscard]] bool fault() const { return fault_; }

 private:
  static constexpr std::size_t kAsked = 12;  // ticks: the longest delay, the present one and a part of another

  void ask(const Cubic& probe_nm);
  [[nodiscard]] Cubic delivered(double tau_s) const;
  ColumnSignals move_column(const DriveTick& tick);
  void keep(const ColumnMeasurement& measured, const ColumnSignals& signals, const DriveTick& tick);

  Column column_;
  DriveTask task_;
  ProbePath requests_;
  bool grant_probe_requests_;
  ColumnPlant plant_;
  ColumnSensors sensors_;
  ColumnDrive* drive_;
  std::int64_t ticks_left_;
  std::array<Cubic, kAsked> asked_{};  // newest first
  Sample sample_;
  bool fresh_ = false;
  std::uint16_t sequence_ = 0;
  Estimate estimate_;
  bool valid_ = false;
  bool fault_ = false;
};

static_assert(Hal<SimulatedColumnHal>);

}  // namespace steerid
