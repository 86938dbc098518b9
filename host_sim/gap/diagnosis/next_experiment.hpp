// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The next experiment: the bounded probe of the EPS that tells best apart what is left standing.
//
// For two models with known parameters and noise density S, a probe with torque spectrum T is worth
// sum |H1 T - H2 T|^2 / S nats (T-optimality: Atkinson and Fedorov 1975). The verdict is held against each of the
// effects that come closest to it, each counting with its probability (Box and Hill 1967), and two effects at once
// against each of them alone. Probes of several bands and
// sizes are simulated on all of them and the best is proposed. None needs more torque than an EPS grants or the record
// itself applied, nor moves the wheel farther than half as much again as the record did.
#pragma once

#include "gap/comparison/comparison.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/preparation/prepared_record.hpp"

namespace steerid {

/// `given` is the simulation that was diagnosed. Where nothing is left to be told apart, `separates` is empty; where
/// what was found or its nearest rival diverges under every probe, `why` is empty, too.
[[nodiscard]] NextExperiment next_experiment(const Diagnosis& diagnosis, const Comparison& comparison,
                                             const PreparedRecord& prepared, const Simulation& given);

}  // namespace steerid
