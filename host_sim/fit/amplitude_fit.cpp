// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/amplitude_fit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "fit/segments.hpp"

namespace steerid {
namespace {

// Amplitudes of the bins of a Hann-windowed signal without its mean, padded to a power of two.
std::vector<double> amplitudes(std::span<const double> signal, std::size_t bins) {
  double mean = 0;
  for (const double v : signal) mean += v;
  mean /= static_cast<double>(signal.size());
  std::vector<double> padded(std::bit_ceil(signal.size()), 0.0);
  double window_sum = 0;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const double phase = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(signal.size());
    const double window = 0.5 * (1 - std::cos(phase));
    window_sum += window;
    padded[i] = window * (signal[i] - mean);
  }
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, padded);
  std::vector<double> out(bins);
  for (std::size_t k = 0; k < bins; ++k) out[k] = 2 * std::abs(spectrum[k + 1]) / window_sum;
  return out;
}

}  // namespace

AmplitudeCurves amplitude_curves(std::span<const double> measured, std::span<const double> model, double period_s,
                                 double limit_hz) {
  AmplitudeCurves curves;
  if (measured.size() < 8 || measured.size() != model.size() || !(period_s > 0)) return curves;
  const std::size_t length = std::bit_ceil(measured.size());
  const double bin_hz = 1 / (period_s * static_cast<double>(length));
  const auto wanted = static_cast<std::size_t>(limit_hz / bin_hz * (1 + 1e-12));
  const std::size_t bins = std::min(wanted, length / 2);
  for (std::size_t k = 1; k <= bins; ++k) curves.frequency_hz.push_back(static_cast<double>(k) * bin_hz);
  curves.measured_rad = amplitudes(measured, bins);
  curves.model_rad = amplitudes(model, bins);
  return curves;
}

std::optional<double> amplitude_fit_percent(const AmplitudeCurves& curves, double limit_hz) {
  double error = 0;
  double total = 0;
  for (std::size_t k = 0; k < curves.frequency_hz.size() && curves.frequency_hz[k] <= limit_hz; ++k) {
    error += std::abs(curves.measured_rad[k] - curves.model_rad[k]);
    total += curves.measured_rad[k];
  }
  if (!(total > 0) || !std::isfinite(error)) return std::nullopt;
  return 100 * (1 - error / total);
}

std::optional<double> free_run_nrmse(std::span<const double> measured, std::span<const double> model) {
  double count = 0;
  double mean = 0;
  double error = 0;
  const std::size_t size = std::min(measured.size(), model.size());
  const auto both = [&](std::size_t i) { return std::isfinite(measured[i]) && std::isfinite(model[i]); };
  for (std::size_t i = 0; i < size; ++i) {
    if (!both(i)) continue;
    ++count;
    mean += measured[i];
    error += (measured[i] - model[i]) * (measured[i] - model[i]);
  }
  mean /= std::max(count, 1.0);
  double power = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (both(i)) power += (measured[i] - mean) * (measured[i] - mean);
  }
  if (!(power > 0)) return std::nullopt;
  return std::sqrt(error / power);
}

ModelQuality model_quality(const Record& record, const BatchFit& fit) {
  ModelQuality quality;
  quality.free_run_nrmse = free_run_nrmse(record.angle_rad, fit.angle_model_rad);
  if (fit.segments.empty()) return quality;
  const auto longest =
      std::max_element(fit.segments.begin(), fit.segments.end(),
                       [](const FitSegment& a, const FitSegment& b) { return a.last - a.first < b.last - b.first; });
  std::vector<double> measured;
  std::vector<double> model;
  for (std::size_t i = longest->first; i <= longest->last; ++i) {
    if (!std::isfinite(fit.angle_model_rad[i])) continue;
    measured.push_back(record.angle_rad[i]);
    model.push_back(fit.angle_model_rad[i]);
  }
  quality.curves = amplitude_curves(measured, model, sample_period_s(record));
  quality.amplitude_fit_percent = amplitude_fit_percent(quality.curves);
  return quality;
}

}  // namespace steerid
