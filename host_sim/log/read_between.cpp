// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/read_between.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "log/kaiser_sinc.hpp"

namespace steerid {

double read_between(std::span<const double> values, double place) {
  constexpr double kSameSample = 1e-9;
  constexpr double kKaiserBeta = 6.0;  // side lobes 63 dB down; half of its main lobe is 3.4 % of the sampling rate
  constexpr auto kReach = static_cast<double>(kReadReach);
  const double outside = std::numeric_limits<double>::quiet_NaN();
  if (!(place > -kSameSample) || place > static_cast<double>(values.size()) - 1 + kSameSample) return outside;
  const double nearest = std::round(place);
  if (std::abs(place - nearest) < kSameSample) return values[static_cast<std::size_t>(nearest)];
  const double before = std::floor(place);
  if (before < kReach - 1 || before + kReach >= static_cast<double>(values.size())) return outside;
  const auto first = static_cast<std::size_t>(before) - (kReadReach - 1);
  double sum = 0;
  double scale = 0;
  for (std::size_t i = first; i < first + 2 * kReadReach; ++i) {
    const double off = static_cast<double>(i) - place;
    const double weight = sinc(std::numbers::pi * off) * kaiser_window(kKaiserBeta, off / kReach);
    sum += weight * values[i];
    scale += weight;
  }
  return sum / scale;
}

}  // namespace steerid
