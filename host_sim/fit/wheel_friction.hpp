// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction of the wheel above the torsion bar.
//
//   torque = J th'' + B th' + C th + constant + F s + v
//
// s is that of the firmware (firmware/identifier/wheel_friction.hpp): the sign of the motion, and nothing in the middle
// where the wheel sticks. A wheel that sticks without hands is held by a friction as large as the torque on it, F at
// most: there s is that torque over F.
//
// Beside a driver F is not to be had: what dry friction leaves of a motion at the probe's frequencies is a damping, and
// the driver's own torque covers the rest. Without hands v is the sensors' noise, and F follows from least squares of
// what the instrument (fit/instrumented_rows.hpp) leaves of the torque on what it leaves of s, both whitened by v's
// spectrum, found anew until F stands. It is stated where it is likelier than none, (n/2) log(S0/S) > (log n)/2
// (Schwarz 1978), positive, and where the wheel has its J and no spring with it: J valid, C and two of its deviations
// below kEmptyWheel.
//
// Under a probe of 1 Nm rms and sensors of 0.5 mrad and 20 mNm F of 0.05 to 0.2 Nm is found 2 to 12 % too large, J
// within 8 % (tests/unit/fit_wheel_friction_test.cpp); with 0.7 mrad F of 0.1 Nm is 20 % too large, and the wheel's B
// what is left.
//
// A record at 100 Hz. Cost: one fit by the instrument where somebody holds the wheel, else three a round, some four
// rounds.
#pragma once

#include <optional>

#include "fit/instrumental_fit.hpp"
#include "fit/motion_fit.hpp"
#include "log/record.hpp"

namespace steerid {

/// Nm/rad: a wheel of less has no hands on it (firmware/app/driver_state.hpp, `hands_off_below`).
inline constexpr double kEmptyWheel = 2;

/// The record as it would be if the wheel, held or not, had no friction of `friction_nm`: its bar reads what is left. A
/// record of another equation stays as it is.
[[nodiscard]] Record less_wheel_friction(const Record& record, double friction_nm);

/// Nm, of a record with bar and rim and without the driver's torque, whoever holds the wheel: what the wheel alone
/// leaves of the torque between them. Nothing where it is within four deviations of none, or the two do not agree
/// beside it.
[[nodiscard]] std::optional<FittedNumber> friction_between_sensors(const Record& record);

struct BareWheelFit {
  FittedNumber friction;  ///< F, Nm
  InstrumentalFit wheel;  ///< beside that friction
};

/// Nothing where the wheel has no such friction, or where somebody holds it.
[[nodiscard]] std::optional<BareWheelFit> fit_bare_wheel(const Record& record);

}  // namespace steerid
