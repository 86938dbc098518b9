// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/residual_spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/hypotheses/measured_motion.hpp"
#include "gap/likelihood/band_mean.hpp"
#include "gap/likelihood/block_spectra.hpp"

namespace steerid::gap {
namespace {

/// Power density of measured minus simulated, pieces averaged.
std::vector<double> density_of(const Record& record, const std::vector<RunStretch>& stretches,
                               const std::vector<double>& simulated, std::size_t length) {
  const auto size = static_cast<Eigen::Index>(length);
  Eigen::VectorXd window(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    window[i] = std::pow(std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(size)), 2);
  }
  std::vector<double> power(length / 2, 0.0);
  double pieces = 0;
  Eigen::FFT<double> transform;
  Eigen::VectorXd piece(size);
  Eigen::VectorXcd lines;
  for (const RunStretch& rows : stretches) {
    for (std::size_t first = rows.first; first + length <= rows.first + rows.count; first += length / 2) {
      for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t at = first + static_cast<std::size_t>(i);
        const double rest = record.angle_rad[at] - simulated[at];
        piece[i] = std::isfinite(rest) ? rest : 0;
      }
      piece.array() *= window.array();
      transform.fwd(lines, piece);
      for (std::size_t k = 0; k < power.size(); ++k) power[k] += std::norm(lines[static_cast<Eigen::Index>(k)]);
      pieces += 1;
    }
  }
  for (double& value : power) value *= 2 / (kResampledRateHz * window.squaredNorm() * std::max(pieces, 1.0));
  return power;
}

}  // namespace

std::vector<double> residual_torque(const Record& record, const std::vector<RunStretch>& stretches,
                                    const std::vector<double>& simulated_rad, const WheelArm& wheel) {
  std::vector<double> out(record.size(), 0.0);
  for (const RunStretch& rows : stretches) {
    const std::size_t n = rows.count;
    if (n < 5) continue;
    const double rate_hz = static_cast<double>(n - 1) / (record.time_s[rows.first + n - 1] - record.time_s[rows.first]);
    std::vector<double> rest(n);
    for (std::size_t i = 0; i < n; ++i) {
      rest[i] = record.angle_rad[rows.first + i] - simulated_rad[rows.first + i];
      if (!std::isfinite(rest[i])) rest[i] = 0;
    }
    rest = smoothed(rest, rate_hz, kSmoothing_hz);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double rate = (rest[i + 1] - rest[i - 1]) * rate_hz / 2;
      const double acceleration = (rest[i + 1] - 2 * rest[i] + rest[i - 1]) * rate_hz * rate_hz;
      out[rows.first + i] =
          wheel.inertia_kgm2 * acceleration + wheel.damping_nms_per_rad * rate + wheel.stiffness_nm_per_rad * rest[i];
    }
  }
  return out;
}

double residual_torque_noise(const NoiseFloor& floor, const WheelArm& wheel) {
  return band_mean(0, kResampledRateHz / 2, [&](double f_hz) {
    if (!floor.holds(f_hz)) return 0.0;
    const double passed = std::exp(-std::numbers::ln2 * std::pow(f_hz / kSmoothing_hz, 2));  // squared gain
    const double inverse = 1 / std::norm(wheel_response(wheel, 2 * std::numbers::pi * f_hz));
    return passed * (floor.angle_variance * inverse + floor.torque_density(f_hz));
  });
}

ResidualSpectrum residual_spectrum(const Record& record, const std::vector<RunStretch>& stretches,
                                   const GapSeries& series, const NoiseFloor& floor, const WheelArm& wheel) {
  std::size_t longest = 0;
  for (const RunStretch& rows : stretches) longest = std::max(longest, rows.count);
  const std::size_t length = std::min<std::size_t>(longest, static_cast<std::size_t>(10 * kResampledRateHz)) / 2 * 2;
  ResidualSpectrum out;
  if (length < 20) return out;
  const std::vector<double> before = density_of(record, stretches, series.refit_rad, length);
  const std::vector<double> after = density_of(record, stretches, series.with_effect_rad, length);
  const std::vector<double> nothing(record.size(), 0.0);
  const std::vector<double> measured = density_of(record, stretches, nothing, length);
  const WheelArm sprung = with_a_spring(wheel);
  for (std::size_t k = 1; k < before.size(); ++k) {
    const double f = static_cast<double>(k) * kResampledRateHz / static_cast<double>(length);
    if (f > 20) break;
    const double gain = std::norm(wheel_response(sprung, 2 * std::numbers::pi * f));
    out.frequency_hz.push_back(f);
    out.measured_rad2_per_hz.push_back(measured[k]);
    out.refit_rad2_per_hz.push_back(before[k]);
    out.with_effect_rad2_per_hz.push_back(after[k]);
    const double noise = floor.angle_variance + gain * floor.torque_density(f);
    out.noise_rad2_per_hz.push_back(floor.holds(f) ? 2 / kResampledRateHz * noise : 0);
  }
  return out;
}

std::optional<Unexplained::Band> band_of_rest(const ResidualSpectrum& spectrum) {
  constexpr std::array<double, 6> kEdges_hz = {0, 0.5, 1, 2, 4, kHighest_hz};
  std::array<double, 5> left{};
  double sum = 0;
  for (std::size_t i = 0; i < spectrum.frequency_hz.size(); ++i) {
    const double above = spectrum.with_effect_rad2_per_hz[i] - spectrum.noise_rad2_per_hz[i];
    for (std::size_t band = 0; band < left.size(); ++band) {
      const double f_hz = spectrum.frequency_hz[i];
      if (!(above > 0) || f_hz < kEdges_hz[band] || f_hz >= kEdges_hz[band + 1]) continue;
      left[band] += above;
      sum += above;
    }
  }
  if (!(sum > 0)) return std::nullopt;
  const auto most = static_cast<std::size_t>(std::ranges::max_element(left) - left.begin());
  return Unexplained::Band{kEdges_hz[most], kEdges_hz[most + 1], left[most] / sum};
}

}  // namespace steerid::gap
