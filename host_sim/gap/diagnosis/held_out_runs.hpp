// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What of a simulation's error on the held-out part may be its numbers' and not its effect's: free runs with other
// numbers.
#pragma once

#include <vector>

#include "gap/diagnosis/final_fit.hpp"

namespace steerid::gap {

/// Mean square of the difference over the held-out part, whose samples are marked; angles one value a sample.
[[nodiscard]] double held_out_square(const std::vector<double>& one, const std::vector<double>& other,
                                     const std::vector<char>& held_out);

/// How far the simulation with the causes, whose run stands in `series`, moves there, rad^2, when its numbers are drawn
/// from what they may be. One free run a draw.
[[nodiscard]] std::vector<double> moved_by_numbers_rad2(const PreparedRecord& prepared, const Simulation& with_effect,
                                                        const GapSeries& series, const FinalFit& fit);

}  // namespace steerid::gap
