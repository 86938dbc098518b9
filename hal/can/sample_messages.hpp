// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The wheel's sample on CAN: three messages with one alive counter (layout.hpp), sent by the EPS; four where torsion
// bar, rim or probe are valid. Those have 16 bits of mNm: one beyond +-32 Nm is sent as invalid.
//
// A receiver gives every frame to SampleAssembly::take. Statuses:
//   kOk          the frame completed a sample, which is written
//   kNoData      the frame is no part of a sample, or the sample is not complete yet
//   kCorrupt     wrong length, checksum or counter: the frame is dropped and counted; a sample it belonged to is lost
//   kOutOfRange  a frame that has come already (a sender that hangs repeats itself), or one that completed a sample
//                which is not credible: dropped and counted
//
// Two senders on the bus contradict each other, and a receiver cannot tell whose frames are the wheel's. So it takes
// neither's: after a contradiction it refuses samples until kTrialSamples in a row came without another. These are
// contradictions:
//   - a second frame of the same part with the same counter and other bits, before or after its sample was delivered;
//   - a WheelColumn where WheelTime says that there is none;
//   - a sample whose stamp is not as many periods after the last one's, to the nearest, as its counter is ahead;
//   - a sample whose counter is ahead by more than kFarthestStep: less than half of its cycle, so that forwards can be
//     told from backwards. Up to six samples in a row may get lost; after more, or a restart of the sender, samples are
//     on trial, too.
// The first sample of all is accepted. None of this is authentication (protection.hpp).
//
// Stamps have 48 bits on the wire: 8.9 years of microseconds. Cost: one CRC of 9 bytes and some shifts a frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/status.hpp"
#include "can/layout.hpp"
#include "can/protection.hpp"
#include "port/sample.hpp"

namespace steerid::can {

inline constexpr std::size_t kSampleFrames = 4;        ///< at most
inline constexpr std::size_t kFewestSampleFrames = 3;  ///< without bar, rim and probe

/// The channels of WheelColumn.
struct ColumnChannel {
  std::int32_t Sample::*torque_mnm = nullptr;
  std::uint8_t valid = 0;
  Signal valid_bit;
  Signal signal;
};
inline constexpr std::array<ColumnChannel, 3> kColumn{{
    {&Sample::torque_bar_mnm, kTorqueBarValid, kTorqueBarValidBit, kTorqueBar},
    {&Sample::torque_rim_mnm, kTorqueRimValid, kTorqueRimValidBit, kTorqueRim},
    {&Sample::probe_mnm, kProbeValid, kProbeValidBit, kProbe},
}};

/// The frames of one sample.
class SampleFrames {
 public:
  /// `alive` is 0 to 14, one more with each sample.
  constexpr SampleFrames(const Sample& sample, std::uint8_t alive)
      : size_((sample.valid_bits & kColumnChannels) != 0 ? kSampleFrames : kFewestSampleFrames) {
    const auto valid = [&sample](std::uint8_t bit) { return (sample.valid_bits & bit) != 0 ? 1 : 0; };
    frames_[0].id = kWheelAngleId;
    put(frames_[0], kAngleValidBit, valid(kAngleValid));
    put(frames_[0], kAngle, sample.angle_urad);
    put(frames_[0], kSampleNumber, sample.sequence);
    frames_[1].id = kWheelTorqueId;
    put(frames_[1], kTorqueDriverValidBit, valid(kTorqueDriverValid));
    put(frames_[1], kTorqueMotorValidBit, valid(kTorqueMotorValid));
    put(frames_[1], kTorqueDriver, sample.torque_driver_mnm);
    put(frames_[1], kTorqueMotor, sample.torque_motor_mnm);
    frames_[2].id = kWheelTimeId;
    put(frames_[2], kColumnSentBit, size_ == kSampleFrames ? 1 : 0);
    put(frames_[2], kStamp, sample.stamp_us);
    frames_[3].id = kWheelColumnId;
    for (const ColumnChannel& channel : kColumn) {
      const std::int32_t torque_mnm = sample.*channel.torque_mnm;
      const bool fits = torque_mnm >= channel.signal.lowest() && torque_mnm <= channel.signal.highest();
      put(frames_[3], channel.valid_bit, fits ? valid(channel.valid) : 0);
      put(frames_[3], channel.signal, torque_mnm);
    }
    for (Frame& frame : frames_) protect(frame, alive);
  }

  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr Frame& operator[](std::size_t at) { return frames_[at]; }
  [[nodiscard]] constexpr const Frame& operator[](std::size_t at) const { return frames_[at]; }
  constexpr Frame* begin() { return frames_.data(); }
  constexpr Frame* end() { return frames_.data() + size_; }
  [[nodiscard]] constexpr const Frame* begin() const { return frames_.data(); }
  [[nodiscard]] constexpr const Frame* end() const { return frames_.data() + size_; }

 private:
  std::array<Frame, kSampleFrames> frames_{};
  std::size_t size_;
};

constexpr SampleFrames pack(const Sample& sample, std::uint8_t alive) { return {sample, alive}; }

/// What was turned down; each stops at 65535.
struct SampleCounters {
  std::uint16_t corrupt = 0;     ///< frames
  std::uint16_t repeated = 0;    ///< frames of a part and counter that had come already
  std::uint16_t incomplete = 0;  ///< samples of which a frame never came
  std::uint16_t refused = 0;     ///< whole samples, at a contradiction and on trial after it
};

class SampleAssembly {
 public:
  static constexpr std::uint8_t kTrialSamples = 10;  ///< a tenth of a second: the task is in fault by then
  static constexpr std::uint8_t kFarthestStep = 7;

  constexpr Status take(const Frame& frame, Sample& sample) {
    const std::size_t part = part_of(frame.id);
    if (part == kSampleFrames) return Status::kNoData;
    if (!intact(frame)) {
      count(counters_.corrupt);
      return Status::kCorrupt;
    }
    const auto alive = static_cast<std::uint8_t>(get(frame, kAliveCounter));
    if (alive != gathering_) begin(alive);
    const auto bit = static_cast<std::uint8_t>(1U << part);
    if ((have_ & bit) != 0) {
      count(counters_.repeated);
      if (frame != frames_[part]) on_trial_ = kTrialSamples;
      return Status::kOutOfRange;
    }
    frames_[part] = frame;
    have_ = static_cast<std::uint8_t>(have_ | bit);
    if (!announced()) {
      on_trial_ = kTrialSamples;
      if (part == kColumnPart) return Status::kOutOfRange;
    }
    return complete() ? judge(sample) : Status::kNoData;
  }

  /// False from a contradiction until enough samples came without one.
  [[nodiscard]] constexpr bool accepts() const { return on_trial_ == 0; }
  [[nodiscard]] constexpr const SampleCounters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kTimePart = 2;
  static constexpr std::size_t kColumnPart = 3;
  static constexpr unsigned kAlways = (1U << kFewestSampleFrames) - 1U;
  static constexpr std::uint8_t kNone = 0xFF;

  static constexpr std::size_t part_of(std::uint16_t id) {
    if (id == kWheelColumnId) return kColumnPart;
    return id == kWheelAngleId ? 0U : id == kWheelTorqueId ? 1U : id == kWheelTimeId ? kTimePart : kSampleFrames;
  }
  [[nodiscard]] constexpr bool have(std::size_t part) const { return (have_ >> part & 1U) != 0; }
  /// What WheelTime says, once it is here.
  [[nodiscard]] constexpr bool column_sent() const { return get(frames_[kTimePart], kColumnSentBit) != 0; }
  /// False with a WheelColumn that WheelTime does not know of.
  [[nodiscard]] constexpr bool announced() const { return !have(kColumnPart) || !have(kTimePart) || column_sent(); }
  [[nodiscard]] constexpr bool complete() const {
    return (have_ & kAlways) == kAlways && (have(kColumnPart) || !column_sent());
  }
  static constexpr void count(std::uint16_t& counter) {
    if (counter < UINT16_MAX) ++counter;
  }

  constexpr void begin(std::uint8_t alive) {
    if (have_ != 0 && !complete()) count(counters_.incomplete);
    gathering_ = alive;
    have_ = 0;
  }

  /// Whether to accept the sample that has just become whole.
  constexpr Status judge(Sample& sample) {
    const Sample whole = unpack();
    if (last_alive_ != kNone && !follows(whole.stamp_us)) on_trial_ = kTrialSamples;
    last_alive_ = gathering_;
    last_stamp_us_ = whole.stamp_us;
    if (on_trial_ > 0) {
      --on_trial_;
      count(counters_.refused);
      return Status::kOutOfRange;
    }
    sample = whole;
    return Status::kOk;
  }

  /// Counter and stamp have gone on together since the last whole sample, and not far.
  [[nodiscard]] constexpr bool follows(std::int64_t stamp_us) const {
    const int step = (gathering_ + kAliveCycle - last_alive_) % kAliveCycle;
    const std::int64_t early_us = step * kTickPeriodUs - (stamp_us - last_stamp_us_);
    return step >= 1 && step <= kFarthestStep && early_us <= kTickPeriodUs / 2 && early_us > -kTickPeriodUs / 2;
  }

  [[nodiscard]] constexpr Sample unpack() const {
    Sample sample;
    const auto bit = [](const Frame& frame, const Signal& signal, std::uint8_t mask) {
      return get(frame, signal) != 0 ? mask : std::uint8_t{0};
    };
    sample.angle_urad = static_cast<std::int32_t>(get(frames_[0], kAngle));
    sample.sequence = static_cast<std::uint16_t>(get(frames_[0], kSampleNumber));
    sample.torque_driver_mnm = static_cast<std::int32_t>(get(frames_[1], kTorqueDriver));
    sample.torque_motor_mnm = static_cast<std::int32_t>(get(frames_[1], kTorqueMotor));
    sample.stamp_us = get(frames_[kTimePart], kStamp);
    unsigned valid = bit(frames_[0], kAngleValidBit, kAngleValid) |
                     bit(frames_[1], kTorqueDriverValidBit, kTorqueDriverValid) |
                     bit(frames_[1], kTorqueMotorValidBit, kTorqueMotorValid);
    if (column_sent()) {
      for (const ColumnChannel& channel : kColumn) {
        sample.*channel.torque_mnm = static_cast<std::int32_t>(get(frames_[kColumnPart], channel.signal));
        valid |= bit(frames_[kColumnPart], channel.valid_bit, channel.valid);
      }
    }
    sample.valid_bits = static_cast<std::uint8_t>(valid);
    return sample;
  }

  std::array<Frame, kSampleFrames> frames_{};
  std::int64_t last_stamp_us_ = 0;   ///< of the last whole sample, accepted or not
  std::uint8_t last_alive_ = kNone;  ///< its counter
  std::uint8_t gathering_ = kNone;   ///< counter of the frames at hand
  std::uint8_t have_ = 0;            ///< bit i: frame i of that counter is there
  std::uint8_t on_trial_ = 0;        ///< samples that will not be accepted
  SampleCounters counters_;
};

}  // namespace steerid::can
