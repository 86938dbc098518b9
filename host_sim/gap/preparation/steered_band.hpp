// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Up to which frequency a driver moves the wheel by a torque of his own that is in no channel of a car's record.
//
// Tv moves the wheel, and the torsion bar with it, by much more than a simulation can be held to. Voluntary movements
// end below kSlowTop_hz (gap/hypotheses/slow_share.hpp); above, what moves an arm comes through the bar: the EPS's
// probe, or the road. There a linear arm is what it is without the driver, and is compared on what is faster alone
// (gap/likelihood/fast_part.hpp).
//
//   he steers   of the bar's power below 2 Hz kOwn or more is more than an arm answers (fit/instrumental_fit.hpp), in
//               the median over pieces, as hands that leave do so for a while: a resting arm has 0 to 0.2, whether it
//               stiffens or leaves or has friction, and a driver of 0.02 rad rms 0.7 to 1.2
//   up to       the lowest line of kSlowTop_hz or more from which on torque and angle are coherent by kTogether or more
//               up to kReached_hz, if the torque brings power there: further up an angle that is late turns that round
#pragma once

#include <optional>

#include "log/record.hpp"

namespace steerid::gap {

/// Beyond it his torque falls, with the square of the frequency or faster, from what the arm does not answer at 1.5 Hz.
struct SteeredBand {
  double to_hz = 0;
  double tail_nm = 0;  ///< rms of what his own torque has beyond it, at most
};

/// `record` is at 100 Hz, with what drives a simulation (plant/driving_torques.hpp). Nothing where nobody steers, where
/// the driver's own torque is in a channel, or where nothing but the driver moves the wheel.
[[nodiscard]] std::optional<SteeredBand> steered_band(const Record& record);

}  // namespace steerid::gap
