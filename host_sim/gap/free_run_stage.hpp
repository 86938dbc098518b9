// The second stage of a comparison (gap/comparison.hpp): by free runs of the real simulation, which knows sticking,
// impacts and everything else that fits on the measured motion only approximate. One thing it does not know: the slow
// torque that no sensor sees (docs/adr/0018-from-where-the-optimum-can-be-reached.md).
#pragma once

#include <vector>

#include "gap/compared_parts.hpp"
#include "gap/comparison.hpp"

namespace steerid {

/// What is there alone, fitted from `start`: J, B, C and the values of there.present. By free runs where these know
/// better.
[[nodiscard]] Whittle::Fit fit_from(const ComparisonSetting& setting, const ComparedParts& there,
                                    const Eigen::VectorXd& start);

/// Fits anew, by free runs, the candidates whose order that may still change.
void fit_by_free_runs(const ComparisonSetting& setting, const ComparedParts& there, std::vector<Candidate>& candidates);

}  // namespace steerid
