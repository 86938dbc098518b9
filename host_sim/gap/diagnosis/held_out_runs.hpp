// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What of a simulation's error on the held-out part may be its numbers' and not its effect's: free runs with other
// numbers.
#pragma once

#include <vector>

#include "gap/diagnosis/final_fit.hpp"

namespace steerid::gap {

/// Samples of the held-out part are those marked in `held_out`; angles one value a sample of the record.
struct HeldOutRuns {
  const PreparedRecord& prepared;
  const Simulation& with_effect;
  const std::vector<double>& with_effect_rad;
  const std::vector<char>& held_out;
};

/// Mean square of the difference over the held-out part.
[[nodiscard]] double held_out_square(const std::vector<double>& one, const std::vector<double>& other,
                                     const std::vector<char>& held_out);

/// How far the simulation with the causes moves there, rad^2, when its numbers are drawn from what they may be. One
/// free run a draw.
[[nodiscard]] std::vector<double> moved_by_numbers_rad2(const HeldOutRuns& runs, const FinalFit& fit);

}  // namespace steerid::gap
