// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/fast_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "log/kaiser_sinc.hpp"
#include "log/record_quality.hpp"
#include "log/resample.hpp"

namespace steerid::gap {
namespace {

constexpr double kDown_db = 60;

/// From the centre on; the weights of both sides sum up to one.
std::vector<double> low_pass(double from_hz) {
  const double reach = kaiser_half_length_s(kDown_db, kTransition_hz) * kResampledRateHz;
  const double cutoff = std::max(from_hz - kTransition_hz / 2, kTransition_hz / 2) / kResampledRateHz;
  std::vector<double> weight = {1};
  double sum = 1;
  for (double i = 1; i <= reach; ++i) {
    weight.push_back(sinc(2 * std::numbers::pi * cutoff * i) * kaiser_window(kaiser_beta(kDown_db), i / reach));
    sum += 2 * weight.back();
  }
  for (double& one : weight) one /= sum;
  return weight;
}

}  // namespace

std::vector<double> fast_part(std::vector<double> signal, double from_hz) {
  if (!(from_hz > 0)) return signal;
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    if (std::isfinite(signal[i])) continue;
    unknown.push_back(i);
    signal[i] = 0;
  }
  const std::vector<double> weight = low_pass(from_hz);
  const auto reach = std::ssize(weight) - 1;
  const auto last = std::ssize(signal) - 1;
  std::vector<double> longer;  // by the mirror images
  const auto mirrored = [&](std::ptrdiff_t from, std::ptrdiff_t by) {
    const double end = signal[static_cast<std::size_t>(from)];
    return 2 * end - signal[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(from + by, 0, last))];
  };
  for (std::ptrdiff_t i = reach; i > 0; --i) longer.push_back(mirrored(0, i));
  longer.insert(longer.end(), signal.begin(), signal.end());
  for (std::ptrdiff_t i = 1; i <= reach; ++i) longer.push_back(mirrored(last, -i));
  std::vector<double> out(signal.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto centre = longer.begin() + static_cast<std::ptrdiff_t>(i) + reach;
    double slow = weight[0] * *centre;
    for (std::ptrdiff_t k = 1; k <= reach; ++k) {
      slow += weight[static_cast<std::size_t>(k)] * (*(centre - k) + *(centre + k));
    }
    out[i] = *centre - slow;
  }
  for (const std::size_t i : unknown) out[i] = std::numeric_limits<double>::quiet_NaN();
  return out;
}

std::vector<double> without_drift(std::vector<double> signal, double from_hz) {
  return fast_part(std::move(signal), std::max(from_hz - kTransition_hz, 0.0));
}

Record fast_part(Record record, double from_hz) {
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    for (const auto column : {&Record::torque_driver_nm, &Record::torque_motor_nm, &Record::angle_rad}) {
      const auto begin = (record.*column).begin() + static_cast<std::ptrdiff_t>(rows.begin);
      const auto end = begin + static_cast<std::ptrdiff_t>(rows.size());
      std::ranges::copy(fast_part(std::vector<double>(begin, end), from_hz), begin);
    }
  }
  return record;
}

}  // namespace steerid::gap
