// One sample of the wheel as a bus delivers it: integers, so that float and fixed-point identifiers read the same
// thing and the fixed-point path never touches a float.
//
// | field             | unit | range that is accepted   | note                                                    |
// | stamp_us          | us   | any, strictly increasing | when the sensors were sampled; simulated time in a host  |
// | angle_urad        | urad | int32                    | positive counter-clockwise                               |
// | torque_driver_mnm | mNm  | int32                    | what the driver applies, positive counter-clockwise      |
// | torque_motor_mnm  | mNm  | int32                    | the EPS motor's target torque, subtracted in the model   |
// | sequence          |      | wraps at 65536           | counts samples at their source, so that losses are seen  |
// | valid_bits        |      | kAngleValid | ...        | a cleared bit: the channel's value must not be used      |
#pragma once

#include <cstdint>

namespace steerid {

inline constexpr std::uint8_t kAngleValid = 1U << 0U;
inline constexpr std::uint8_t kTorqueDriverValid = 1U << 1U;
inline constexpr std::uint8_t kTorqueMotorValid = 1U << 2U;
inline constexpr std::uint8_t kAllChannelsValid = kAngleValid | kTorqueDriverValid | kTorqueMotorValid;

struct Sample {
  std::int64_t stamp_us = 0;
  std::int32_t angle_urad = 0;
  std::int32_t torque_driver_mnm = 0;
  std::int32_t torque_motor_mnm = 0;
  std::uint16_t sequence = 0;
  std::uint8_t valid_bits = kAllChannelsValid;
};

/// Nominal time between two samples. The identifier's filters are designed for it.
inline constexpr std::int64_t kTickPeriodUs = 10'000;

}  // namespace steerid
