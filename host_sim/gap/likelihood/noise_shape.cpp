// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/noise_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "log/record_quality.hpp"
#include "log/resample.hpp"

namespace steerid {
namespace {

/// A high pass at 15 Hz, 74 dB down from 10 Hz on (Blackman's window).
std::vector<double> high_pass() {
  constexpr double kPass_hz = 15;
  constexpr int kReach = 30;
  constexpr double kPi = std::numbers::pi;
  const double cut = kPass_hz / kResampledRateHz;
  std::vector<double> taps;
  for (int k = -kReach; k <= kReach; ++k) {
    const double turn = kPi * k / (kReach + 1);
    const double window = 0.42 + 0.5 * std::cos(turn) + 0.08 * std::cos(2 * turn);
    taps.push_back((k == 0 ? 1 - 2 * cut : -std::sin(2 * kPi * cut * k) / (kPi * k)) * window);
  }
  return taps;
}

/// Sums over the fast part of what is left.
struct Moments {
  static constexpr std::size_t kLags = 30;
  double count = 0;
  double size = 0;
  double square = 0;
  double fourth = 0;
  std::vector<double> products = std::vector<double>(kLags);  ///< of samples so many apart, from one on

  void add(const std::vector<double>& fast) {
    for (std::size_t i = 0; i < fast.size(); ++i) {
      const double power = fast[i] * fast[i];
      count += 1;
      size += std::abs(fast[i]);
      square += power;
      fourth += power * power;
      for (std::size_t lag = 1; lag <= std::min(kLags, i); ++lag) products[lag - 1] += fast[i] * fast[i - lag];
    }
  }

  /// The variance of both statistics over that of as many independent samples: both begin with the fourth Hermite
  /// polynomial, whose covariance is the correlation's fourth power.
  [[nodiscard]] double dependence() const {
    double sum = 1;
    for (const double product : products) sum += 2 * std::pow(product / square, 4);
    return sum;
  }
};

void add_stretch(std::span<const double> measured, std::span<const double> run, const std::vector<double>& taps,
                 Moments& moments) {
  std::vector<double> rest;
  const auto take = [&] {
    std::vector<double> fast;
    for (std::size_t i = 0; i + taps.size() <= rest.size(); ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < taps.size(); ++k) sum += taps[k] * rest[i + k];
      fast.push_back(sum);
    }
    moments.add(fast);
    rest.clear();
  };
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (std::isfinite(run[i])) {
      rest.push_back(measured[i] - run[i]);
    } else {
      take();
    }
  }
  take();
}

}  // namespace

double departure_from_normal(const Record& record, std::span<const double> run_rad) {
  const std::vector<double> taps = high_pass();
  Moments moments;
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    add_stretch(std::span(record.angle_rad).subspan(rows.begin, rows.size()), run_rad.subspan(rows.begin, rows.size()),
                taps, moments);
  }
  constexpr double kFewest = 400;
  if (moments.count < kFewest || !(moments.square > 0)) return 0;
  const double variance = moments.square / moments.count;
  const double kurtosis = moments.fourth / moments.count / (variance * variance);
  const double geary = moments.size / moments.count / std::sqrt(variance);
  const double chance = std::sqrt(moments.dependence() / moments.count);
  constexpr double kPi = std::numbers::pi;
  return std::max(std::abs(kurtosis - 3) / std::sqrt(24.0),
                  std::abs(geary - std::sqrt(2 / kPi)) / std::sqrt(1 - 3 / kPi)) /
         chance;
}

}  // namespace steerid
