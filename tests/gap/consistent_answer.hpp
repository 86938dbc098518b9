// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What an answer says in one place, held against what it says in another: whatever the record, and right or wrong.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/shrinkage.hpp"

namespace steerid::test {

inline ::testing::AssertionResult is_consistent(const gap::Diagnosis& d) {
  const gap::GapSizes& gap = d.gap;
  const auto no = [&](const char* what) {
    return ::testing::AssertionFailure() << d.verdict << ": " << what << "; nrmse as given " << gap.sim_nrmse
                                         << ", refitted " << gap.refit_nrmse << ", with the effect "
                                         << gap.with_effect_nrmse << ", noise " << gap.floor_nrmse;
  };
  const double rounding = 1e-9;
  const auto above = [&](double a, double b) { return a > b * (1 + rounding); };
  if (above(gap.refit_nrmse, gap.sim_nrmse)) return no("a refit that is worse than the simulation as given");
  if (!d.only_the_loop_holds && std::isfinite(gap.refit_nrmse) && !std::isfinite(gap.with_effect_nrmse)) {
    return no("a free run that does not stay finite");
  }
  if (d.causes.empty() && d.verdict == "unknown" && above(gap.with_effect_nrmse, gap.refit_nrmse)) {
    return no("nothing is named, and something makes the free run worse");
  }
  if (d.verdict == "none" && above(gap.with_effect_nrmse, gap.sim_nrmse)) return no("none, and something is changed");
  // By less than noise two runs may differ either way.
  if (d.verdict == "parameters" && above(gap.with_effect_nrmse, std::hypot(gap.sim_nrmse, gap.floor_nrmse))) {
    return no("J, B and C that make the free run worse");
  }
  if (d.surrogate && above(gap.with_effect_nrmse, gap.refit_nrmse)) return no("a surrogate that brings nothing nearer");
  if (d.unexplained.complete && above(gap.with_effect_nrmse, (1 + gap::kFloorKnownTo) * gap.floor_nrmse)) {
    return no("complete, and more than noise is left");
  }
  if (std::isfinite(gap.closed_fraction.value) && gap.closed_fraction.low < -1) {
    return no("a closed fraction whose interval reaches below -100 %");
  }
  if (!std::ranges::is_sorted(d.causes, std::ranges::greater(), &gap::Cause::closes)) {
    return no("a change that closes less before one that closes more");
  }
  double sum = 0;
  for (const gap::RankedEffect& one : d.ranking) sum += one.probability;
  if (!(std::abs(sum - 1) <= 1e-9)) return no("probabilities whose sum is not one");
  const auto is_probability = [](double p) { return p >= 0 && p <= 1; };
  const bool probable = std::ranges::all_of(d.inclusion, is_probability, &gap::ChangeInclusion::probability);
  return probable ? ::testing::AssertionSuccess() : no("a probability below 0 or above 1");
}

}  // namespace steerid::test
