// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The next experiment of a simulation without effects, whose diagnosis compares single effects and pairs: the verdict
// is held against each of the effects that come closest to it, each counting with its probability (Box and Hill 1967),
// and two effects at once against each of them alone.
#pragma once

#include "gap/comparison/comparison.hpp"
#include "gap/diagnosis/best_probe.hpp"

namespace steerid {

/// `given` is the simulation that was diagnosed. Where nothing is left to be told apart, `separates` is empty and `why`
/// says so.
[[nodiscard]] NextExperiment next_experiment(const Diagnosis& diagnosis, const Comparison& comparison,
                                             const PreparedRecord& prepared, const Simulation& given);

}  // namespace steerid
