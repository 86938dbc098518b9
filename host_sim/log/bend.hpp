// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How far four samples are off a parabola: the third divided difference. Of a motion that is smooth over them next to
// nothing is left, and of white noise of variance 1 a variance of 1.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace steerid {

using BendWeights = std::array<double, 4>;

/// Weights of samples at the places `at`, no two of which are the same.
inline BendWeights bend_weights(const std::array<double, 4>& at) {
  BendWeights weight{};
  double squares = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    weight[i] = 1;
    for (std::size_t k = 0; k < at.size(); ++k) {
      if (i != k) weight[i] /= at[i] - at[k];
    }
    squares += weight[i] * weight[i];
  }
  for (double& one : weight) one /= std::sqrt(squares);
  return weight;
}

}  // namespace steerid
