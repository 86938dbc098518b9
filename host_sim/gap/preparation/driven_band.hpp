// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Up to which frequency the torque of a record drives the wheel, and does not answer it.
//
// A position loop, or a driver, answers the measured angle, with its noise n: T = ... - K n. What is found between T
// and theta = H T + n leans towards the inverse of that answer by n's share of the motion (Ljung, System
// Identification, 1999, section 13.4), and where only noise is left to be answered it is the loop that is found: as a
// second mass, a delay, or an effect without a name.
//
// Which of both it is shows in the power that flows. A wheel is passive: a torque that drives it brings power,
// Im(T conj(theta)) w > 0. A loop that damps takes power out of what it answers. Hence:
//   closed    from 15 to 22 Hz, where no drive moves a wheel, torque and angle are coherent and the torque takes power
//             out, by more than an angle that is a few milliseconds late would make of inertia
//   driven    the bands of 1 Hz below the first from which on it takes power out in every one
//
// That is asked of the motor's torque, of the driver's and of both together: where a hand trembles it drives, and the
// loop answers none the less.
// Where the loop is open, or drives the wheel even there (a stiff position loop), all lines count.
//
// An angle that is recorded late turns the phase: at 18 Hz by a quarter in 14 ms, and the answer seems to drive. Its
// power is seen with both at the same instants only, as soon as the delay is known. What is coherent is no noise of the
// sensors all the same, and bounds their level from above only.
#pragma once

#include "gap/likelihood/noise_floor.hpp"
#include "log/record.hpp"

namespace steerid::gap {

struct DrivenBand {
  /// The highest frequency to compare hypotheses at: kHighest_hz, or less where a loop answers the angle's noise below.
  double highest_hz = kHighest_hz;
  /// From 15 to 22 Hz torque and angle are not coherent: what they hold there is their sensors' noise.
  bool noise_alone_above = true;
};

/// `pass_hz`: what is faster was filtered away when the record was resampled. `late_s`: how late the angle is known to
/// be recorded.
[[nodiscard]] DrivenBand driven_band(const Record& record, double pass_hz = kAllPassed_hz, double late_s = 0);

}  // namespace steerid::gap
