// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether a record's numbers can be a steering wheel in the units they are taken in, and how late its torque is.
//
// An angle in degrees that is taken for radians makes J, B and C 57 times too small, and the wheel turn 57 times too
// far; a torque in mNm makes them 1000 times too large. What a wheel and an arm can be:
//
// | what                         | limit      | why                                                        |
// | ---------------------------- | ---------- | ---------------------------------------------------------- |
// | turned, from end to end      | 45 rad     | seven turns, more than any lorry's from lock to lock       |
// | J of arm and wheel, at least | 0.01 kg m2 | half of the lightest arm of Lv et al. 2018, tables I, II   |
// | J of arm and wheel, at most  | 1 kg m2    | four times their heaviest arm, 0.18, with a wheel of 0.05  |
//
// Lighter than that are small machines too (a servo, a robot's leg). So what has neither a torsion bar nor a rim
// transducer is taken for degrees only when it also turned through more than one whole turn, which what has a spring or
// a weight to bring it back does not. That misses such drives in degrees that stay within 3 degrees to either side.
//
// J is that of fit_motion(), where it is shown: of the wheel between rim and bar where both are there, else of what is
// identified. Where the driver's own torque is not measured and a probe is, J is that of fit_by_instrument(): beside a
// driver who steers least squares finds the column below the bar, whose J over 1 + assist may be 0.006 kg m2. Where
// such a probe has driven nothing that stands out of the noise no J is shown.
//
// An angle and a torque that are named for each other: as named there is no wheel (J beyond the limits or not shown, or
// J and B of opposite signs), and with the two exchanged there is one. Where the driver's own torque is known, what is
// left unexplained tells the two apart as well: the exchange has to be likelier by eight nats, four deviations. Where
// it is not, the torque that is explained is another one; there the limits alone decide, and J as named has to lie
// below them.
//
// tests/unit/fit_unit_check_test.cpp measures how often this is right.
#pragma once

#include <cstdint>

#include "fit/motion_fit.hpp"
#include "log/log_format.hpp"
#include "log/record.hpp"

namespace steerid {

inline constexpr double kFarthestTurnRad = 45.0;
inline constexpr double kLightestKgm2 = 0.01;
inline constexpr double kHeaviestKgm2 = 1.0;

struct UnitCheck {
  enum class Verdict : std::uint8_t {
    kPlausible,
    kTurnsTooFar,  ///< no steering wheel turns so far: the angle is in degrees or counts
    kTooLight,     ///< the angle is in degrees
    kTooHeavy,     ///< the torque is in another unit, or this is another machine
    kExchanged,    ///< the angle is the torque, and the torque the angle
  } verdict = Verdict::kPlausible;
  double turned_rad = 0;                ///< from end to end
  double inertia_kgm2 = 0;              ///< 0 where the motion does not show it; of kExchanged with the two exchanged
  Channel exchanged = Channel::kAngle;  ///< of kExchanged: the torque
};

/// `record` is at 100 Hz and in the units that it is taken in.
[[nodiscard]] UnitCheck check_units(const Record& record);

/// Whether the torques are later than the angle, by how much the wheel's motion explains of them.
struct TorqueDelay {
  double late_s = 0;   ///< positive: the torque is later than the angle
  bool shown = false;  ///< more than half a sample and beyond chance (four deviations), within 60 ms
};

[[nodiscard]] TorqueDelay torque_delay(const Record& record);

/// Whether a record can tell how late its torques are: all torque is known, or that on either side of the wheel. A
/// driver whose torque nobody measured moves bar and angle as a delay would.
[[nodiscard]] bool tells_delays(const Record& record);

}  // namespace steerid
