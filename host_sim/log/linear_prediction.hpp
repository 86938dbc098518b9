// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The filter that predicts a stationary series by what was before.
//
// Levinson and Durbin's recursion on its autocovariances: with e_t = sum_k w_k x_(t-k), w_0 = 1, the variance of e is
// the least that kOrder weights leave.
#pragma once

#include <array>
#include <cstddef>

namespace steerid {

template <std::size_t kOrder>
struct LinearPrediction {
  std::array<double, kOrder + 1> weight{};  ///< of the present one first
  double variance = 0;                      ///< of the error, in the covariances' unit
};

/// `covariance`: of lags 0 to kOrder. Of a series that is predicted exactly it stops there.
template <std::size_t kLags>
[[nodiscard]] LinearPrediction<kLags - 1> linear_prediction(const std::array<double, kLags>& covariance) {
  LinearPrediction<kLags - 1> out;
  out.weight[0] = 1;
  out.variance = covariance[0];
  for (std::size_t order = 1; order < kLags && out.variance > 0; ++order) {
    double sum = 0;
    for (std::size_t k = 0; k < order; ++k) sum += out.weight[k] * covariance[order - k];
    const double reflection = -sum / out.variance;
    const std::array<double, kLags> before = out.weight;
    for (std::size_t k = 1; k <= order; ++k) out.weight[k] = before[k] + reflection * before[order - k];
    out.variance *= 1 - reflection * reflection;
  }
  return out;
}

}  // namespace steerid
