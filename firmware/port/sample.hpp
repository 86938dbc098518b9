// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One sample of the wheel as a bus delivers it: integers, so that float and fixed-point identifiers read the same
// thing and the fixed-point path never touches a float.
//
//   field              unit  accepted by default   note
//   stamp_us           us    strictly increasing   when the sensors were sampled; simulated time in a host
//   angle_urad         urad  +-20 rad              positive counter-clockwise
//   torque_driver_mnm  mNm   +-100 Nm              the driver's voluntary torque, positive counter-clockwise
//   torque_motor_mnm   mNm   +-100 Nm              the EPS motor's target torque, subtracted in the model
//   torque_bar_mnm     mNm   +-100 Nm              torsion bar, positive when the driver turns counter-clockwise
//   torque_rim_mnm     mNm   +-100 Nm              the hand's torque on the rim, positive counter-clockwise
//   probe_mnm          mNm   +-100 Nm              the part of the motor's torque that was asked for to identify
//   sequence                 any, wraps at 65536   the source's sample number, for traces and bus tools;
//                                                  the task does not read it
//   valid_bits               kAngleValid | ...     a cleared bit: the channel is absent, or must not be used
//
// No wheel has all of these channels. Those that are there decide which equation is used (port/equation.hpp); a sender
// clears the bits of the others. The bits that a sample starts with are those of the paper's equation.
//
// The ranges are those of InputLimits (app/input_supervision.hpp), which also bounds the change from sample to sample.
// The task sees lost samples by their stamps.
#pragma once

#include <cstdint>

namespace steerid {

inline constexpr std::uint8_t kAngleValid = 1U << 0U;
inline constexpr std::uint8_t kTorqueDriverValid = 1U << 1U;
inline constexpr std::uint8_t kTorqueMotorValid = 1U << 2U;
inline constexpr std::uint8_t kTorqueBarValid = 1U << 3U;
inline constexpr std::uint8_t kTorqueRimValid = 1U << 4U;
inline constexpr std::uint8_t kProbeValid = 1U << 5U;
/// What a steering column has beyond the paper's arrangement. A bus carries them only where one of them is valid.
inline constexpr std::uint8_t kColumnChannels = kTorqueBarValid | kTorqueRimValid | kProbeValid;
/// Angle and the two torques of the paper's equation: what a sample holds unless its sender says otherwise.
inline constexpr std::uint8_t kAllChannelsValid = kAngleValid | kTorqueDriverValid | kTorqueMotorValid;

/// As logs, configs and sentences name the channel with this valid bit.
constexpr const char* channel_name(std::uint8_t valid_bit) {
  switch (valid_bit) {
    case kAngleValid:
      return "angle";
    case kTorqueDriverValid:
      return "torque_driver";
    case kTorqueMotorValid:
      return "torque_motor";
    case kTorqueBarValid:
      return "torque_bar";
    case kTorqueRimValid:
      return "torque_rim";
    case kProbeValid:
      return "probe";
    default:
      return "no channel";
  }
}
inline constexpr std::uint8_t kEveryChannel = kAllChannelsValid | kColumnChannels;

struct Sample {
  std::int64_t stamp_us = 0;
  std::int32_t angle_urad = 0;
  std::int32_t torque_driver_mnm = 0;
  std::int32_t torque_motor_mnm = 0;
  std::int32_t torque_bar_mnm = 0;
  std::int32_t torque_rim_mnm = 0;
  std::int32_t probe_mnm = 0;
  std::uint16_t sequence = 0;
  std::uint8_t valid_bits = kAllChannelsValid;
};

/// Nominal time between two samples. The identifier's filters are designed for it.
inline constexpr std::int64_t kTickPeriodUs = 10'000;

}  // namespace steerid
