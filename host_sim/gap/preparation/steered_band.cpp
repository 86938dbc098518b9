// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/steered_band.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "fit/instrumental_fit.hpp"
#include "gap/hypotheses/slow_share.hpp"
#include "gap/likelihood/piece_lines.hpp"
#include "gap/preparation/joint_power.hpp"
#include "log/quantile.hpp"
#include "log/resample.hpp"

namespace steerid::gap {
namespace {

constexpr double kPiece_s = 5;
constexpr double kOwn = 0.5;       // of the bar's power below 2 Hz
constexpr double kTogether = 0.5;  // coherence: half of the angle's power comes from the torque
constexpr double kReached_hz = 5;  // by every probe
constexpr double kFalls_hz = 1.5;  // behind any driver's band

/// Mean squares of consecutive pieces, about the mean of all.
std::vector<double> powers(const std::vector<double>& signal) {
  const auto rows = static_cast<std::size_t>(kPiece_s * InstrumentedRows::kRowsPerS);
  double mean = 0;
  for (const double x : signal) mean += x / static_cast<double>(signal.size());
  std::vector<double> out;
  for (std::size_t first = 0; first + rows <= signal.size(); first += rows) {
    double& sum = out.emplace_back(0);
    for (std::size_t i = first; i < first + rows; ++i) sum += (signal[i] - mean) * (signal[i] - mean);
  }
  return out;
}

/// Of the measured torque's power below 2 Hz, in the median over pieces.
double own_share(const InstrumentedRows& rows, const InstrumentalFit& fit) {
  const Eigen::Vector4d arm(fit.inertia.value, fit.damping.value, fit.stiffness.value, fit.constant_nm);
  const std::vector<double> all = powers(rows.slow_unexplained(Eigen::Vector4d::Zero()));
  std::vector<double> share = powers(rows.slow_unexplained(arm));
  if (share.empty()) return 0;
  for (std::size_t i = 0; i < share.size(); ++i) share[i] /= all[i];
  return median(std::move(share));
}

/// What is faster than `above_hz` of a torque that falls from kFalls_hz on as behind two poles, rms: of what the arm
/// does not answer there.
double tail_rms_nm(const InstrumentalFit& fit, double above_hz) {
  std::complex<double> whitened = 1;
  const std::complex<double> later = std::polar(1.0, -2 * std::numbers::pi * kFalls_hz / InstrumentedRows::kRowsPerS);
  std::complex<double> delay = 1;
  for (const double a : fit.noise.coefficients()) whitened += a * (delay *= later);
  const double density = 2 * fit.noise_nm * fit.noise_nm / InstrumentedRows::kRowsPerS / std::norm(whitened);
  return std::sqrt(density * std::pow(kFalls_hz, 4) / (3 * std::pow(above_hz, 3)));
}

}  // namespace

std::optional<SteeredBand> steered_band(const Record& record) {
  if (voluntary_torque_known(record.equation()) || record.motor_channel == kTorqueMotorValid) return std::nullopt;
  const InstrumentedRows rows(record);
  const InstrumentalFit fit = fit_by_instrument(rows);
  if (fit.rows == 0 || !(own_share(rows, fit) >= kOwn)) return std::nullopt;
  const double step_hz = kResampledRateHz / kPieceRows;
  std::vector<JointPower> lines(static_cast<std::size_t>(kReached_hz / step_hz) + 1);
  const auto visit = [&](const Eigen::VectorXcd& torque, const Eigen::VectorXcd& angle) {
    for (Eigen::Index k = 1; k < std::ssize(lines); ++k) lines[static_cast<std::size_t>(k)].add(torque[k], angle[k]);
  };
  for_each_piece(record, record.net_torque_nm(), record.angle_rad, visit);
  const auto together = [&](std::size_t k) { return lines[k].coherence() >= kTogether; };
  std::size_t k = lines.size() - 1;
  if (!together(k)) return std::nullopt;
  while (static_cast<double>(k - 1) * step_hz >= kSlowTop_hz && together(k - 1)) --k;
  if (!(lines[k].power() > 0)) return std::nullopt;
  const double to_hz = static_cast<double>(k) * step_hz;
  return SteeredBand{.to_hz = to_hz, .tail_nm = tail_rms_nm(fit, to_hz)};
}

}  // namespace steerid::gap
