// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The last fit of a chosen hypothesis: on everything but the held-out part, by free runs where the effect depends on
// the motion, with 95 % intervals.
#pragma once

#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/preparation/prepared_record.hpp"
#include "gap/sets/set_fit.hpp"

namespace steerid::gap {

struct FinalFit {
  Point at;
  std::vector<std::vector<BoundedValue>> parameters;  ///< one list an effect
  BaseWheel base;
  NoiseFloor floor;
  double excess = 1;
  double choose_lines = 0;     ///< of a quarter of the record; the held-out part is as long
  std::vector<Point> drawn{};  ///< as it may be as well, drawn from the fit's spread
};

/// Of a set of changes, as it was fitted: its effects are those of the set.
[[nodiscard]] FinalFit final_fit(const PreparedRecord& prepared, const SetFitter& fitter, const FittedSet& one);

}  // namespace steerid::gap
