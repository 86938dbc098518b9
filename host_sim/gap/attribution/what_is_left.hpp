// What is left when a hypothesis is fitted: to shapes without a name (gap/comparison/rivals.hpp), and by a free run.
#pragma once

#include <vector>

#include "gap/comparison/comparison.hpp"
#include "gap/model/compared_parts.hpp"

namespace steerid {

/// What the wheel alone and the few best leave to shapes without a name, and how the free runs of these err.
void note_what_is_left(const ComparisonSetting& setting, const ComparedParts& there,
                       std::vector<Candidate>& candidates);

}  // namespace steerid
