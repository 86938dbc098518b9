// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/faulty_drive.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "app/run_loop.hpp"
#include "app/task.hpp"
#include "backend/simulated.hpp"
#include "port/port.hpp"

namespace steerid {
namespace {

using FlashedTask = IdentificationTask<float>;

/// The simulated back end with a faulty bus before it.
class FaultyBus {
 public:
  FaultyBus(const Scenario& scenario, const Fault& fault, const FaultTime& when, const FlashedTask& task,
            FaultyDrive& drive)
      : hal_(scenario), fault_(&fault), when_(when.during()), task_(&task), drive_(&drive) {}

  Status wait_tick() {
    ++tick_;
    return hal_.wait_tick();
  }
  Status read_sample(Sample& sample) {
    const Status status = hal_.read_sample(sample);
    if (status == Status::kOk && when_.covers(tick_ * kTickPeriodUs)) {
      const int number = drive_->bus.spoiled++;
      if (fault_->bus) fault_->bus(sample, number);
    }
    const bool flagged = status == Status::kOk && (sample.valid_bits & kAllChannelsValid) != kAllChannelsValid;
    const bool hole = flagged || status != Status::kOk;
    drive_->bus.flagged += flagged ? 1 : 0;
    drive_->bus.holes += hole && !in_hole_ ? 1 : 0;
    in_hole_ = hole;
    return status;
  }
  Status publish(const Estimate& estimate) {
    const WheelIdentifier<float>& identifier = task_->identifier();
    Outcome& now = drive_->outcomes.emplace_back();
    now.estimate = estimate;
    now.finite = identifier.value().allFinite() && identifier.standard_deviation().allFinite() &&
                 std::isfinite(identifier.noise_nm());
    now.sound = identifier.sound();
    return hal_.publish(estimate);
  }
  Status request_probe_torque(std::int32_t torque_mnm) { return hal_.request_probe_torque(torque_mnm); }
  void set_valid(bool level) { drive_->outcomes.back().valid = level; }
  void set_fault(bool level) { drive_->outcomes.back().fault = level; }
  void kick_watchdog() { hal_.kick_watchdog(); }

 private:
  SimulatedHal hal_;
  const Fault* fault_;
  sensor::During when_;
  const FlashedTask* task_;
  FaultyDrive* drive_;
  std::int64_t tick_ = -1;
  bool in_hole_ = false;
};
static_assert(Hal<FaultyBus>);

}  // namespace

FaultyDrive faulty_drive(const Fault& fault, const FaultTime& when, double duration_s, std::uint64_t seed,
                         const WheelArm& wheel, double unmeasured_percent) {
  Scenario scenario;
  scenario.task = task_settings(TaskKind::kProbe, HandPosition::kBoth3And9, seed);
  scenario.task.arm = wheel;
  scenario.wheel = wheel;
  scenario.duration_s = duration_s;
  scenario.task.unmeasured_percent = unmeasured_percent;
  if (fault.sensors) fault.sensors(scenario.sensors, when);
  FaultyDrive drive;
  FlashedTask task;
  FaultyBus hal(scenario, fault, when, task, drive);
  if (run_loop(hal, task) != Status::kOk) throw std::logic_error("the simulated loop ended with an error");
  return drive;
}

}  // namespace steerid
