// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A Gaussian and its first two derivatives as taps: value, rate and acceleration of a sampled signal behind one and the
// same low pass, so that differentiating does not drown in noise and no delay is invented.
//
// The low pass is exp(-(2 pi f sigma)^2 / 2): 3 dB at 0.133 / sigma. With sigma of two sampling periods and more what
// sampling makes of the derivatives is below 1e-4. The taps reach six sigmas: of the ends that four leave out the
// second derivative would make a spring of 2.7/s2 (sigma 20 ms) times the inertia.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace steerid {

class GaussianTaps {
 public:
  GaussianTaps(double sigma_s, double period_s)
      : reach_(static_cast<std::size_t>(std::lround(6 * sigma_s / period_s))) {
    const auto bell = [&](double t) { return std::exp(-0.5 * t * t / (sigma_s * sigma_s)); };
    const int far = static_cast<int>(reach_);
    double sum = 0;
    for (int k = -far; k <= far; ++k) sum += bell(k * period_s);
    for (int k = -far; k <= far; ++k) {
      const double t = k * period_s;
      const double g = bell(t) / sum;
      smooth.push_back(g);
      // Of the convolution, whose argument is -t.
      first.push_back(g * t / (sigma_s * sigma_s));
      second.push_back(g * (t * t / (sigma_s * sigma_s) - 1) / (sigma_s * sigma_s));
    }
  }

  std::vector<double> smooth, first, second;  ///< for x[i + k], k = -reach() to reach()

  [[nodiscard]] std::size_t reach() const { return reach_; }

  /// Sum of taps[k] x[i + k]; `x` has reach() samples on both sides of i.
  [[nodiscard]] double at(const std::vector<double>& taps, std::span<const double> x, std::size_t i) const {
    double sum = 0;
    for (std::size_t k = 0; k < taps.size(); ++k) sum += taps[k] * x[i + k - reach_];
    return sum;
  }

 private:
  std::size_t reach_;
};

}  // namespace steerid
