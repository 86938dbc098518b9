// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a sample's neighbours say of it: the cubic through two on either side, evenly spaced.
#pragma once

#include <cstddef>
#include <span>

namespace steerid {

/// Of x[i] by x[i-2], x[i-1], x[i+1], x[i+2].
[[nodiscard]] inline double by_neighbours(std::span<const double> x, std::size_t i) {
  return (4 * (x[i - 1] + x[i + 1]) - (x[i - 2] + x[i + 2])) / 6;
}

}  // namespace steerid
