// What is left when a hypothesis is fitted: to shapes without a name (gap/comparison/rivals.hpp), and by a free run.
#pragma once

#include <vector>

#include "gap/comparison/comparison.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid {

/// How far the free run of a candidate strays.
void note_run(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one);

/// What shapes without a name gain beyond a candidate. By far the dearer of the two.
void note_shapes(const ComparisonSetting& setting, const ComparedParts& there, Candidate& one);

/// Both of the wheel alone and of the few best, and what the runs of all miss slowly.
void note_what_is_left(const ComparisonSetting& setting, const ComparedParts& there,
                       std::vector<Candidate>& candidates);

}  // namespace steerid
