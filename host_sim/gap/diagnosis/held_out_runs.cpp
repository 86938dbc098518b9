// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/held_out_runs.hpp"

#include <algorithm>
#include <cmath>

namespace steerid::gap {

double held_out_square(const std::vector<double>& one, const std::vector<double>& other,
                       const std::vector<char>& held_out) {
  double squares = 0;
  double count = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (held_out[i] == 0) continue;
    squares += std::pow(one[i] - other[i], 2);
    count += 1;
  }
  return squares / std::max(count, 1.0);
}

std::vector<double> moved_by_numbers_rad2(const PreparedRecord& prepared, const Simulation& with_effect,
                                          const GapSeries& series, const FinalFit& fit) {
  std::vector<double> squares;
  for (const Point& drawn : fit.drawn) {
    Simulation moved = with_effect;
    moved.wheel = drawn.wheel;
    for (Effect& effect : moved.effects) {
      if (const Effect* found = drawn.find(*effect.type)) effect = *found;
    }
    const double square = held_out_square(prepared.run(moved), series.with_effect_rad, series.held_out);
    if (std::isfinite(square)) squares.push_back(square);
  }
  return squares;
}

}  // namespace steerid::gap
