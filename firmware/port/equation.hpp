// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which equation the channels of a wheel allow, in one place for the firmware and for the host.
//
//   above the torsion bar   (Ja + Jw) th'' + (Ba + Bw) th' + Ca th = Tv - Tbar
//   arm alone                     Ja th'' +       Ba th' + Ca th = Tv - Trim
//   the paper's equation 1         J th'' +        B th' +  C th = T_driver - T_motor
//
// Tv, the driver's voluntary torque, is known only where there is a `torque_driver`: in a simulation, or from a model
// of muscles. Without it Tv is what nobody measures, and only an estimator that is consistent whatever the driver does
// may be used.
//
//   | equation     | known torque          | identifies                    | channels beside the angle              |
//   | kDriverMotor | T_driver - T_motor    | arm and wheel, light column   | torque_driver, torque_motor            |
//   | kDriverBar   | Tv - Tbar             | arm and wheel                 | torque_driver, torque_bar              |
//   | kDriverRim   | Tv - Trim             | arm alone                     | torque_driver, torque_rim, no bar      |
//   | kBar         | - Tbar                | arm and wheel                 | torque_bar (a rim beside it: the wheel)|
//   | kRim         | - Trim                | arm alone                     | torque_rim, no bar                     |
//   | kNone        |                       | nothing                       | any others, or no angle                |
//
// With a bar or a rim the motor's torque is no input: it acts below the bar. A probe alone identifies nothing; it is
// the instrument. A task takes the equation of the first sample that allows one, and keeps to it while a channel is
// invalid; another one holds once samples have agreed on it for a second (app/input_supervision.hpp).
#pragma once

#include <cstdint>

#include "port/sample.hpp"

namespace steerid {

enum class Equation : std::uint8_t {
  kNone = 0,
  kDriverMotor = 1,
  kDriverBar = 2,
  kDriverRim = 3,
  kBar = 4,
  kRim = 5,
};

constexpr const char* name(Equation equation) {
  switch (equation) {
    case Equation::kNone:
      return "none";
    case Equation::kDriverMotor:
      return "driver_motor";
    case Equation::kDriverBar:
      return "driver_bar";
    case Equation::kDriverRim:
      return "driver_rim";
    case Equation::kBar:
      return "bar";
    case Equation::kRim:
      return "rim";
  }
  return "unknown";
}

/// The equation that the channels with these bits allow.
constexpr Equation equation_of(std::uint8_t valid_bits) {
  const auto there = [valid_bits](std::uint8_t bit) { return (valid_bits & bit) != 0; };
  if (!there(kAngleValid)) return Equation::kNone;
  const bool driver = there(kTorqueDriverValid);
  if (there(kTorqueBarValid)) return driver ? Equation::kDriverBar : Equation::kBar;
  if (there(kTorqueRimValid)) return driver ? Equation::kDriverRim : Equation::kRim;
  return driver && there(kTorqueMotorValid) ? Equation::kDriverMotor : Equation::kNone;
}

/// The channels whose values `equation` uses, and which must therefore be valid in a sample that is used.
constexpr std::uint8_t channels_of(Equation equation) {
  switch (equation) {
    case Equation::kNone:
      return 0;
    case Equation::kDriverMotor:
      return kAngleValid | kTorqueDriverValid | kTorqueMotorValid;
    case Equation::kDriverBar:
      return kAngleValid | kTorqueDriverValid | kTorqueBarValid;
    case Equation::kDriverRim:
      return kAngleValid | kTorqueDriverValid | kTorqueRimValid;
    case Equation::kBar:
      return kAngleValid | kTorqueBarValid;
    case Equation::kRim:
      return kAngleValid | kTorqueRimValid;
  }
  return 0;
}

/// False where the driver's own torque is not measured, and moves the wheel all the same.
constexpr bool voluntary_torque_known(Equation equation) { return (channels_of(equation) & kTorqueDriverValid) != 0; }

/// What stands against the driver in `equation`: the torque of the motor, the bar or the rim, mNm.
constexpr std::int32_t opposing_torque_mnm(const Sample& sample, Equation equation) {
  const std::uint8_t channels = channels_of(equation);
  if ((channels & kTorqueBarValid) != 0) return sample.torque_bar_mnm;
  if ((channels & kTorqueRimValid) != 0) return sample.torque_rim_mnm;
  return (channels & kTorqueMotorValid) != 0 ? sample.torque_motor_mnm : 0;
}

/// The driver's voluntary torque where it is measured, else 0, mNm.
constexpr std::int32_t voluntary_torque_mnm(const Sample& sample, Equation equation) {
  return voluntary_torque_known(equation) ? sample.torque_driver_mnm : 0;
}

/// The torque that is known to act on what is identified, mNm. Within the accepted ranges the difference fits.
constexpr std::int32_t known_torque_mnm(const Sample& sample, Equation equation) {
  return voluntary_torque_mnm(sample, equation) - opposing_torque_mnm(sample, equation);
}

}  // namespace steerid
