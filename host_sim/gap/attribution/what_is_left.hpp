// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is left when a hypothesis is fitted: to shapes without a name (gap/comparison/rivals.hpp), and by a free run.
#pragma once

#include <vector>

#include "gap/comparison/comparison.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid {

/// How far the free run of a candidate strays.
void note_run(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one);

/// How far the free runs of the few best stray, and of single effects what the runs of all miss slowly.
void note_runs(const ComparisonSetting& setting, const ComparedParts& there, std::vector<Candidate>& candidates);

/// What shapes without a name gain beyond a candidate, and whether its slow torque is a single tone. By far dearer than
/// a run, and of weight for the likeliest alone.
void note_shapes(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one);

}  // namespace steerid
