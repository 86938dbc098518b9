// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a simulation is given in place of an effect that none of the vocabulary is.
#pragma once

#include <string>

#include "gap/comparison/comparison.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/preparation/prepared_record.hpp"

namespace steerid {

/// The effect whose free run, where its fit has not been, comes nearest to the measured angle; `most_probable` where
/// free runs cannot say; empty where none comes plainly nearer than J, B and C alone. The likelihood weighs a residual
/// by its colour and a run does not: what explains the record best may be simulated worse than nothing at all.
/// `most_probable`: the id of a candidate, or empty. Cost: a free run a candidate.
[[nodiscard]] std::string stand_in(const PreparedRecord& prepared, const Simulation& simulation,
                                   const Comparison& comparison, const std::string& most_probable);

}  // namespace steerid
