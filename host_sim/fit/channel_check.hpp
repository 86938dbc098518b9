// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether a record's torques are what their channels say, as far as two of them show it together.
//
//   rim and bar         Jw th'' + Bw th' = Trim - Tbar: between the two is the wheel alone, whatever the driver does
//   bar and motor       Jc th'' + Bc th' + Cr th = Tbar + Tmotor, but for friction and the twist of the bar: between
//                       these two is the column
//
// A record with torque_bar and torque_rim has its wheel identified, and is told whether the two sensors agree. A record
// whose torque_driver and torque_motor have the wheel alone between them holds the reading of a rim transducer and of a
// torsion bar. What is between a torque_driver and a torque_motor that answer each other may be the column.
#pragma once

#include "fit/motion_fit.hpp"
#include "log/record.hpp"

namespace steerid {

/// The wheel between a rim transducer and the torsion bar.
struct WheelBetween {
  MotionFit fit;      ///< of Trim - Tbar: Jw, Bw, and a C that is 0 where both sensors are right
  FittedNumber gain;  ///< of the bar against the rim, from Trim = Jw th'' + Bw th' + gain * Tbar

  enum class Verdict {
    kUnknown,   ///< the wheel's motion does not show its inertia
    kAgree,     ///< nothing but a wheel between the two, and gain 1 within kGainTolerance
    kSame,      ///< one and the same signal
    kSwapped,   ///< the wheel would have a negative inertia: the one is the other, or both are turned round
    kOpposed,   ///< one of the two is turned round
    kDisagree,  ///< another gain, or something else than a wheel between the two
  } verdict = Verdict::kUnknown;

  static constexpr double kGainTolerance = 0.05;
};

/// `record` has both channels.
[[nodiscard]] WheelBetween wheel_between(const Record& record);

/// What the pair torque_driver and torque_motor is taken for.
struct TorquePair {
  enum class Verdict {
    kAsNamed,
    kRimAndBar,    ///< torque_driver is the hand's torque on the rim, torque_motor the torsion bar
    kBarAndRim,    ///< the other way round
    kReaction,     ///< torque_driver is what arm and wheel answer: torsion bar or rim transducer, or turned round
    kBarAndMotor,  ///< they may be a torsion bar (or a rim transducer) and the motor below it
  } verdict = Verdict::kAsNamed;
  MotionFit between;  ///< of the wheel, the arm, or the column
};

/// `record` has torque_driver and torque_motor and neither bar nor rim. The last two verdicts are possibilities: a
/// driver's own torque that is written the other way round, or an assistance that is, looks alike.
[[nodiscard]] TorquePair torque_pair(const Record& record);

}  // namespace steerid
