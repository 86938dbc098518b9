// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/diagnosis.hpp"

#include <algorithm>
#include <cmath>

namespace steerid::gap {

bool names_several(const Diagnosis& diagnosis) { return diagnosis.causes.size() > 1 && !diagnosis.surrogate; }

double probability_of_answer(const Diagnosis& diagnosis) {
  if (!diagnosis.causes.empty() && !diagnosis.surrogate) {
    return std::ranges::min_element(diagnosis.causes, {}, &Cause::probability)->probability;
  }
  const auto own = std::ranges::find(diagnosis.ranking, diagnosis.verdict, &RankedEffect::id);
  return own == diagnosis.ranking.end() ? std::nan("") : own->probability;
}

}  // namespace steerid::gap
