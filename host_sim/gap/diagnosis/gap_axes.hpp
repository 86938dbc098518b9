// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The refit's excess residual, share by share, along every axis on which an unmodelled effect can show.
//
//   velocity, position   the measured motion's; bins of equally many samples
//   amplitude            how far the wheel swings within a second to either side
//   reversal             time since the wheel last turned round
//   time                 since the record's origin
//   frequency            bands of the residual angle
//   channel              what the residual torque follows: driver's torque, motor's torque, angle, or none of them
//
// The share of a bin is the residual torque's power in it (of the angle, for frequency), less what noise would leave,
// over the same sum of all bins. Intervals: 95 %, from a bootstrap over blocks of 2 s.
#pragma once

#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/hypotheses/measured_motion.hpp"

namespace steerid::gap {

/// The most concentrated first. `noise_nm2`: the residual torque's variance at the floor.
[[nodiscard]] std::vector<GapAxis> gap_axes(const Record& record, const MeasuredMotion& motion, const GapSeries& series,
                                            const ResidualSpectrum& spectrum, double noise_nm2);

}  // namespace steerid::gap
