// The next experiment: the bounded probe of the EPS that tells best apart what is left standing.
//
// For two models with known parameters and noise density S, a probe with torque spectrum T is worth
// sum |H1 T - H2 T|^2 / S nats (T-optimality: Atkinson and Fedorov 1975; between several models each pair counts with
// both probabilities: Box and Hill 1967). Probes of several bands and sizes, all within what the EPS may apply, are
// simulated on both models and the best is proposed.
#pragma once

#include "gap/comparison.hpp"
#include "gap/diagnosis.hpp"

namespace steerid {

[[nodiscard]] NextExperiment next_experiment(const Diagnosis& diagnosis, const Comparison& comparison,
                                             const Whittle& whittle, const Simulation& simulation);

}  // namespace steerid
