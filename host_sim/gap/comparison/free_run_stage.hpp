// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The second stage of a comparison (gap/comparison/comparison.hpp): by free runs of the real simulation, which knows
// sticking, impacts and everything else that fits on the measured motion only approximate. One thing it does not know:
// the slow torque that no sensor sees (docs/adr/0015). Where that matters a
// fit of another kind may take its place (gap/comparison/preferred_fit.hpp).
#pragma once

#include <vector>

#include "gap/comparison/comparison.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid {

/// Fits a candidate beside what is there from where it is: by free runs where these know better, and on the motion that
/// they carry where that does.
void fit_from_here(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one);

/// Fits anew, by free runs, the candidates whose order that may still change.
void fit_by_free_runs(const ComparisonSetting& setting, const ComparedParts& there, std::vector<Candidate>& candidates);

}  // namespace steerid
