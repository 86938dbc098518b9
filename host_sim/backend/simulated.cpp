// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "backend/simulated.hpp"

#include <cmath>
#include <cstdlib>

namespace steerid {
namespace {

void reserve_record(Record& record, std::size_t rows) {
  record.time_s.reserve(rows);
  record.torque_driver_nm.reserve(rows);
  record.torque_motor_nm.reserve(rows);
  record.angle_rad.reserve(rows);
}

void append(Record& record, double time_s, double torque_driver_nm, double torque_motor_nm, double angle_rad) {
  record.time_s.push_back(time_s);
  record.torque_driver_nm.push_back(torque_driver_nm);
  record.torque_motor_nm.push_back(torque_motor_nm);
  record.angle_rad.push_back(angle_rad);
}

}  // namespace

void SimulatedDrive::reserve(std::size_t ticks) {
  reserve_record(measured, ticks);
  reserve_record(truth, ticks);
  unmeasured_torque_nm.reserve(ticks);
  estimates.reserve(ticks);
}

SimulatedHal::SimulatedHal(const Scenario& scenario, SimulatedDrive* drive)
    : task_(scenario.task),
      probe_path_(scenario.task.eps),
      grant_probe_requests_(scenario.grant_probe_requests),
      plant_(scenario.effects, {.wheel = scenario.wheel, .seed = scenario.task.seed}),
      recorder_(scenario.effects, {.wheel = scenario.wheel, .seed = scenario.task.seed}),
      sensors_(scenario.sensors, scenario.task.seed),
      drive_(drive),
      ticks_left_(std::llround(scenario.duration_s / kTickS)) {
  plant_.start(0.0, {});
  if (drive_ != nullptr) drive_->reserve(static_cast<std::size_t>(ticks_left_));
}

TickSignals SimulatedHal::move_wheel(const TaskTorques& torques) {
  const Cubic motor = torques.motor + probe_path_.next();
  const WheelState from = plant_.state();
  plant_.advance(torques.driver + torques.unmeasured, motor, kTickS);
  const WheelState to = plant_.state();
  return {torques.driver, motor, Cubic::hermite(from.angle_rad, from.rate_rad_s, to.angle_rad, to.rate_rad_s, kTickS)};
}

Measurement SimulatedHal::measure(const Analogue& analogue, double rate_rad_s) {
  Channels channels{.time_s = static_cast<double>(analogue.sampled_us) * 1e-6,
                    .torque_driver_nm = analogue.torque_driver_nm,
                    .torque_motor_nm = analogue.torque_motor_nm,
                    .angle_rad = analogue.angle_rad,
                    .rate_rad_s = rate_rad_s};
  recorder_.before_noise(channels);
  Measurement measured = sensors_.convert({analogue.sampled_us, analogue.stamp_us, channels.torque_driver_nm,
                                           channels.torque_motor_nm, channels.angle_rad});
  channels.torque_driver_nm = measured.torque_driver_nm;
  channels.torque_motor_nm = measured.torque_motor_nm;
  channels.angle_rad = measured.angle_rad;
  recorder_.after_noise(channels);
  measured.torque_driver_nm = channels.torque_driver_nm;
  measured.torque_motor_nm = channels.torque_motor_nm;
  measured.angle_rad = channels.angle_rad;
  return measured;
}

// The tick that begins now is simulated to its end at once, so that the sensors may be read anywhere within it. What
// the task requests after reading can act from the next tick on.
Status SimulatedHal::wait_tick() {
  if (ticks_left_ == 0) return Status::kEndOfStream;
  --ticks_left_;
  const TaskTorques torques = task_.next();
  const TickSignals truth = move_wheel(torques);
  const Analogue analogue = sensors_.sample(truth);
  const double tau_s = static_cast<double>(analogue.sampled_us % kTickPeriodUs) * 1e-6;
  const Measurement measured = measure(analogue, truth.angle.slope(tau_s));
  ++sequence_;
  fresh_ = measured.delivered;
  if (!fresh_) return Status::kOk;
  sample_ = to_sample(measured, sequence_);
  if (drive_ != nullptr) keep(measured, analogue, truth, torques.unmeasured);
  return Status::kOk;
}

void SimulatedHal::keep(const Measurement& measured, const Analogue& analogue, const TickSignals& truth,
                        const Cubic& unmeasured) {
  append(drive_->measured, static_cast<double>(measured.stamp_us) * 1e-6, measured.torque_driver_nm,
         measured.torque_motor_nm, measured.angle_rad);
  const double tau_s = static_cast<double>(analogue.sampled_us % kTickPeriodUs) * 1e-6;
  append(drive_->truth, static_cast<double>(analogue.sampled_us) * 1e-6, truth.torque_driver.at(tau_s),
         truth.torque_motor.at(tau_s), truth.angle.at(tau_s));
  drive_->unmeasured_torque_nm.push_back(unmeasured.at(tau_s));
}

Status SimulatedHal::read_sample(Sample& sample) {
  if (!fresh_) return Status::kNoData;
  fresh_ = false;
  sample = sample_;
  return Status::kOk;
}

Status SimulatedHal::publish(const Estimate& estimate) {
  estimate_ = estimate;
  if (drive_ != nullptr) drive_->estimates.push_back(estimate);
  return Status::kOk;
}

Status SimulatedHal::request_probe_torque(std::int32_t torque_mnm) {
  if (std::abs(static_cast<std::int64_t>(torque_mnm)) > kLargestProbeMnm) return Status::kOutOfRange;
  if (grant_probe_requests_) probe_path_.request(static_cast<double>(torque_mnm) * 1e-3);
  return Status::kOk;
}

}  // namespace steerid
