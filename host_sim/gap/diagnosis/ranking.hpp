// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// From the scores of a comparison (gap/attribution/attribution.hpp) to the answer by name: who is how likely, and who
// may be it as well.
#pragma once

#include <string>
#include <vector>

#include "gap/attribution/attribution.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/preparation/record_defects.hpp"

namespace steerid {

/// Every id a verdict can have, the most probable first; the probabilities' sum is one. `probability`: one for each of
/// `input.all` and, last, that of `unknown`. The record's own defects compete with what the comparison found.
[[nodiscard]] std::vector<RankedEffect> ranking_of(const AttributionInput& input,
                                                   const std::vector<double>& probability,
                                                   const std::vector<RecordDefect>& defects);

/// Probabilities as they are with the record's own defects, the most probable first.
[[nodiscard]] std::vector<RankedEffect> with_defects(std::vector<RankedEffect> ranking,
                                                     const std::vector<RecordDefect>& defects);

/// Other effects that may well be the cause, or that explain the record as well with more numbers of their own, if not
/// with J, B and C nearer to the simulation's.
[[nodiscard]] std::vector<std::string> equivalent_to(const std::string& verdict,
                                                     const std::vector<RankedEffect>& ranking,
                                                     const AttributionInput& input);

/// The most probable effect that was fitted; empty when there is none.
[[nodiscard]] std::string best_effect(const std::vector<RankedEffect>& ranking, const Comparison& comparison);

}  // namespace steerid
