// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The replayed back end of the port: a recorded drive behind the same calls that the microcontroller answers.
//
// Tick k is at k * kTickPeriodUs after the record's first stamp; a row is there to be read from the tick nearest to its
// stamp on, and once only. Where the record has a gap the ticks go on without samples, as they would in the car, for
// kLongestGapTicks; by then the task waits for nothing but the next sample, and the rest of the gap is passed over in
// one tick, so that a gap of days costs as much as one of seconds. The record is expected near 100 Hz
// (log/resample.hpp); rows that share a tick are read one a tick, late.
//
// Integers: angle in 1e-6 rad, torques in 1e-3 Nm, to the nearest. A value beyond int32 clears its valid bit; a channel
// that the record has not has it cleared throughout. A record of another machine can be counted in other units:
// `torque_unit_nm` says how many Nm (or N) one of the port's newton metres stands for, `angle_unit_rad` likewise, and
// the estimates come out in the ratio of the two.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "log/record.hpp"
#include "port/port.hpp"

namespace steerid {

class ReplayedHal {
 public:
  static constexpr int kLongestGapTicks =
      200;  ///< a fault is told after 10, the driver's hands are forgotten after 100

  /// `record` must outlive this object. Every published estimate is kept: one a tick.
  explicit ReplayedHal(const Record& record, double torque_unit_nm = 1.0, double angle_unit_rad = 1.0)
      : record_(&record), torque_unit_nm_(torque_unit_nm), angle_unit_rad_(angle_unit_rad) {
    estimates_.reserve(record.size());
    times_us_.reserve(record.size());
  }

  Status wait_tick() {
    if (next_row_ >= record_->size()) return Status::kEndOfStream;
    now_us_ += started_ ? kTickPeriodUs : 0;
    started_ = true;
    if (ticks_since_row_++ >= kLongestGapTicks) now_us_ = std::max(now_us_, tick_of(stamp(next_row_)));
    times_us_.push_back(now_us_);
    return Status::kOk;
  }

  Status read_sample(Sample& sample) {
    const std::int64_t stamp_us = stamp(next_row_);
    if (stamp_us > now_us_ + kTickPeriodUs / 2) return Status::kNoData;
    times_us_.back() = stamp_us;
    sample = sample_of(next_row_);
    ++next_row_;
    ticks_since_row_ = 0;
    return Status::kOk;
  }

  /// What a bus would deliver of a row.
  [[nodiscard]] Sample sample_of(std::size_t row) const {
    Sample sample;
    sample.stamp_us = stamp(row);
    sample.sequence = static_cast<std::uint16_t>(row);
    sample.valid_bits = record_->channels;
    const double per_mnm = 1e3 / torque_unit_nm_;
    sample.angle_urad = integer(record_->angle_rad, row, 1e6 / angle_unit_rad_, kAngleValid, sample);
    sample.torque_driver_mnm = integer(record_->torque_driver_nm, row, per_mnm, kTorqueDriverValid, sample);
    sample.torque_motor_mnm = integer(record_->torque_motor_nm, row, per_mnm, kTorqueMotorValid, sample);
    sample.torque_bar_mnm = integer(record_->torque_bar_nm, row, per_mnm, kTorqueBarValid, sample);
    sample.torque_rim_mnm = integer(record_->torque_rim_nm, row, per_mnm, kTorqueRimValid, sample);
    sample.probe_mnm = integer(record_->probe_nm, row, per_mnm, kProbeValid, sample);
    return sample;
  }

  Status publish(const Estimate& estimate) {
    estimates_.push_back(estimate);
    return Status::kOk;
  }
  /// A record cannot be asked for another torque than it holds.
  Status request_probe_torque(std::int32_t torque_mnm) { return torque_mnm == 0 ? Status::kOk : Status::kOutOfRange; }
  void set_valid(bool level) { valid_ = level; }
  void set_fault(bool level) { fault_ = level; }
  void kick_watchdog() {}

  [[nodiscard]] const std::vector<Estimate>& estimates() const { return estimates_; }
  /// When each tick was: the stamp of the row that it read, accepted or not, or its own time in a gap. Never back.
  [[nodiscard]] const std::vector<std::int64_t>& times_us() const { return times_us_; }
  [[nodiscard]] bool valid() const { return valid_; }
  [[nodiscard]] bool fault() const { return fault_; }

 private:
  [[nodiscard]] std::int64_t stamp(std::size_t row) const {
    return std::llround((record_->time_s[row] - record_->time_s.front()) * 1e6);
  }

  /// When the first tick is from which on a row of this stamp can be read.
  static std::int64_t tick_of(std::int64_t stamp_us) {
    return (stamp_us + (kTickPeriodUs - 1) / 2) / kTickPeriodUs * kTickPeriodUs;
  }

  /// A row's value of a channel; 0 where the record has none, which its valid bit says.
  [[nodiscard]] static std::int32_t integer(const std::vector<double>& column, std::size_t row, double per_unit,
                                            std::uint8_t channel, Sample& sample) {
    if ((sample.valid_bits & channel) == 0) return 0;
    const double value = column[row] * per_unit;
    if (!(std::abs(value) <= 2147483000.0)) {
      sample.valid_bits = static_cast<std::uint8_t>(sample.valid_bits & ~channel);
      return 0;
    }
    return static_cast<std::int32_t>(std::lround(value));
  }

  const Record* record_;
  double torque_unit_nm_;
  double angle_unit_rad_;
  std::size_t next_row_ = 0;
  std::int64_t now_us_ = 0;
  int ticks_since_row_ = 0;
  bool started_ = false;
  bool valid_ = false;
  bool fault_ = false;
  std::vector<Estimate> estimates_;
  std::vector<std::int64_t> times_us_;
};

static_assert(Hal<ReplayedHal>);

}  // namespace steerid
