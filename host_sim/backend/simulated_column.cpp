// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "backend/simulated_column.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "backend/simulated.hpp"

namespace steerid {
namespace {

constexpr std::uint8_t kChannels = kAngleValid | kTorqueMotorValid | kColumnChannels;

void append(Record& record, double time_s, double motor_nm, double bar_nm, double rim_nm, double probe_nm,
            double angle_rad) {
  record.channels = kChannels;
  record.time_s.push_back(time_s);
  record.torque_driver_nm.push_back(0);
  record.torque_motor_nm.push_back(motor_nm);
  record.torque_bar_nm.push_back(bar_nm);
  record.torque_rim_nm.push_back(rim_nm);
  record.probe_nm.push_back(probe_nm);
  record.angle_rad.push_back(angle_rad);
}

}  // namespace

SimulatedColumnHal::SimulatedColumnHal(const ColumnScenario& scenario, ColumnDrive* drive)
    : column_(scenario.column),
      task_(scenario.drive, scenario.column),
      requests_(EpsTorque::kSmooth),
      grant_probe_requests_(scenario.grant_probe_requests),
      plant_(scenario.column),
      sensors_(scenario.sensors, scenario.drive.seed),
      drive_(drive),
      ticks_left_(std::llround(scenario.duration_s / kTickS)) {
  plant_.start({});
}

void SimulatedColumnHal::ask(const Cubic& probe_nm) {
  std::copy_backward(asked_.begin(), asked_.end() - 1, asked_.end());
  asked_[0] = probe_nm;
}

/// What the motor makes of the probe from `tau_s` in this tick on, as long as no tick of asking ends meanwhile.
Cubic SimulatedColumnHal::delivered(double tau_s) const {
  const double asked_s = tau_s - column_.probe_delay_s;  // in this tick's time
  constexpr double kRounding = 1e-9;
  const double ticks = std::floor(asked_s / kTickS + kRounding);
  return column_.probe_gain * asked_[static_cast<std::size_t>(-ticks)].shifted(asked_s - ticks * kTickS);
}

/// Moves the column to the tick's end. The torques over the tick are the cubics through four instants of it: they swing
/// with some 10 Hz at most, so that these differ from them by 1e-6 of an amplitude. Where dry friction above the bar
/// stops the wheel within a tick the hand's torque jumps, and the cubic is right at the four instants alone.
ColumnSignals SimulatedColumnHal::move_column(const DriveTick& tick) {
  constexpr std::size_t kThirds = 3;
  // Where asking goes from one tick's cubic to the next one's.
  const double seam_s = column_.probe_delay_s - kTickS * std::floor(column_.probe_delay_s / kTickS);
  std::array<ColumnTorques, kThirds + 1> at;
  const ColumnState from = plant_.state();
  const auto inputs = [&](double tau_s) {
    ColumnInputs now = tick.inputs.shifted(tau_s);
    now.probe_nm = delivered(tau_s);
    return now;
  };
  double tau_s = 0;
  for (std::size_t i = 0; i < kThirds; ++i) {
    at[i] = plant_.torques(inputs(tau_s));
    const double end_s = kTickS * static_cast<double>(i + 1) / kThirds;
    if (tau_s < seam_s && seam_s < end_s) {
      plant_.advance(inputs(tau_s), seam_s - tau_s);
      tau_s = seam_s;
    }
    plant_.advance(inputs(tau_s), end_s - tau_s);
    tau_s = end_s;
  }
  ColumnInputs last = tick.inputs.shifted(kTickS);
  last.probe_nm.c0 = delivered(seam_s).at(kTickS - seam_s);
  at[kThirds] = plant_.torques(last);
  const ColumnState to = plant_.state();
  const auto through = [&](double ColumnTorques::*torque) {
    return Cubic::through(at[0].*torque, at[1].*torque, at[2].*torque, at[3].*torque, kTickS);
  };
  return {.torque_motor = through(&ColumnTorques::motor_nm),
          .angle = Cubic::hermite(from.angle_rad, from.rate_rad_s, to.angle_rad, to.rate_rad_s, kTickS),
          .torque_bar = through(&ColumnTorques::bar_nm),
          .torque_rim = through(&ColumnTorques::rim_nm),
          .probe = asked_[0]};
}

Status SimulatedColumnHal::wait_tick() {
  if (ticks_left_ == 0) return Status::kEndOfStream;
  --ticks_left_;
  const DriveTick tick = task_.next();
  ask(tick.probe_asked_nm + requests_.next());
  const ColumnSignals signals = move_column(tick);
  const ColumnMeasurement measured = sensors_.read(signals);
  ++sequence_;
  fresh_ = measured.wheel.delivered;
  if (!fresh_) return Status::kOk;
  sample_ = to_sample(measured, sequence_);
  if (drive_ != nullptr) keep(measured, signals, tick);
  return Status::kOk;
}

void SimulatedColumnHal::keep(const ColumnMeasurement& measured, const ColumnSignals& signals, const DriveTick& tick) {
  const Measurement& wheel = measured.wheel;
  append(drive_->measured, static_cast<double>(wheel.stamp_us) * 1e-6, wheel.torque_motor_nm, measured.torque_bar_nm,
         measured.torque_rim_nm, measured.probe_nm, wheel.angle_rad);
  const double tau_s = static_cast<double>(measured.sampled_us % kTickPeriodUs) * 1e-6;
  append(drive_->undisturbed, static_cast<double>(measured.sampled_us) * 1e-6, signals.torque_motor.at(tau_s),
         signals.torque_bar.at(tau_s), signals.torque_rim.at(tau_s), signals.probe.at(tau_s), signals.angle.at(tau_s));
  drive_->truth.push_back(
      {{tick.inputs.inertia_kgm2.at(tau_s), tick.inputs.damping_nms.at(tau_s), tick.inputs.stiffness_nm.at(tau_s)},
       tick.inputs.voluntary_nm.at(tau_s)});
}

Status SimulatedColumnHal::read_sample(Sample& sample) {
  if (!fresh_) return Status::kNoData;
  fresh_ = false;
  sample = sample_;
  return Status::kOk;
}

Status SimulatedColumnHal::publish(const Estimate& estimate) {
  estimate_ = estimate;
  if (drive_ != nullptr) drive_->estimates.push_back(estimate);
  return Status::kOk;
}

Status SimulatedColumnHal::request_probe_torque(std::int32_t torque_mnm) {
  if (std::abs(static_cast<std::int64_t>(torque_mnm)) > kLargestProbeMnm) return Status::kOutOfRange;
  if (grant_probe_requests_) requests_.request(static_cast<double>(torque_mnm) * 1e-3);
  return Status::kOk;
}

}  // namespace steerid
