// The wheel's sample on CAN: three messages with one alive counter (layout.hpp), sent by the EPS.
//
// A receiver gives every frame to SampleAssembly::take. Statuses:
//   kOk          the frame completed a sample, which is written
//   kNoData      the frame is no part of a sample, or the sample is not complete yet
//   kCorrupt     wrong length, checksum or counter: the frame is dropped and counted; a sample it belonged to is lost
//   kOutOfRange  a repetition of the sample delivered last (a sender that hangs repeats itself): dropped and counted
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

inline constexpr std::size_t kSampleFrames = 3;

/// The three frames of a sample; `alive` is 0 to 14, one more with each sample.
constexpr std::array<Frame, kSampleFrames> pack(const Sample& sample, std::uint8_t alive) {
  std::array<Frame, kSampleFrames> frames{};
  const auto valid = [&sample](std::uint8_t bit) { return (sample.valid_bits & bit) != 0 ? 1 : 0; };
  frames[0].id = kWheelAngleId;
  put(frames[0], kAngleValidBit, valid(kAngleValid));
  put(frames[0], kAngle, sample.angle_urad);
  put(frames[0], kSampleNumber, sample.sequence);
  frames[1].id = kWheelTorqueId;
  put(frames[1], kTorqueDriverValidBit, valid(kTorqueDriverValid));
  put(frames[1], kTorqueMotorValidBit, valid(kTorqueMotorValid));
  put(frames[1], kTorqueDriver, sample.torque_driver_mnm);
  put(frames[1], kTorqueMotor, sample.torque_motor_mnm);
  frames[2].id = kWheelTimeId;
  put(frames[2], kStamp, sample.stamp_us);
  for (Frame& frame : frames) protect(frame, alive);
  return frames;
}

struct SampleCounters {
  std::uint16_t corrupt = 0;     ///< frames, stops at 65535
  std::uint16_t repeated = 0;    ///< samples
  std::uint16_t incomplete = 0;  ///< samples of which a frame never came
};

class SampleAssembly {
 public:
  constexpr Status take(const Frame& frame, Sample& sample) {
    const std::size_t part = part_of(frame.id);
    if (part == kSampleFrames) return Status::kNoData;
    if (!intact(frame)) {
      count(counters_.corrupt);
      return Status::kCorrupt;
    }
    const auto alive = static_cast<std::uint8_t>(get(frame, kAliveCounter));
    if (alive == delivered_) {
      if (part + 1 == kSampleFrames) count(counters_.repeated);
      return Status::kOutOfRange;
    }
    if (alive != gathering_) {
      if (have_ != 0) count(counters_.incomplete);
      gathering_ = alive;
      have_ = 0;
    }
    frames_[part] = frame;
    have_ = static_cast<std::uint8_t>(have_ | (1U << part));
    if (have_ != kComplete) return Status::kNoData;
    have_ = 0;
    delivered_ = alive;
    sample = unpack();
    return Status::kOk;
  }

  [[nodiscard]] constexpr const SampleCounters& counters() const { return counters_; }

 private:
  static constexpr std::uint8_t kComplete = (1U << kSampleFrames) - 1U;
  static constexpr std::uint8_t kNone = 0xFF;

  static constexpr std::size_t part_of(std::uint16_t id) {
    return id == kWheelAngleId ? 0U : id == kWheelTorqueId ? 1U : id == kWheelTimeId ? 2U : kSampleFrames;
  }
  static constexpr void count(std::uint16_t& counter) {
    if (counter < UINT16_MAX) ++counter;
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
    sample.stamp_us = get(frames_[2], kStamp);
    sample.valid_bits = static_cast<std::uint8_t>(bit(frames_[0], kAngleValidBit, kAngleValid) |
                                                  bit(frames_[1], kTorqueDriverValidBit, kTorqueDriverValid) |
                                                  bit(frames_[1], kTorqueMotorValidBit, kTorqueMotorValid));
    return sample;
  }

  std::array<Frame, kSampleFrames> frames_{};
  std::uint8_t gathering_ = kNone;
  std::uint8_t delivered_ = kNone;
  std::uint8_t have_ = 0;
  SampleCounters counters_;
};

}  // namespace steerid::can
