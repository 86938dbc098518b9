// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/preparation/driven_band.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include "gap/likelihood/piece_lines.hpp"
#include "gap/preparation/joint_power.hpp"
#include "log/resample.hpp"

namespace steerid::gap {
namespace {

constexpr double kQuiet_hz = 15;
constexpr double kQuietEnd_hz = 22;

/// Of one torque, as it pushes the wheel.
DrivenBand drives(const Record& record, const std::vector<double>& torque_nm, double late_s) {
  // Coherence: 0.02 by chance in 10 s, and 0.012 at most in 150 open records of a minute.
  constexpr double kTogether = 0.1;
  constexpr double kTakesOut = -0.25;   // 14 degrees: an angle that is 2 ms late at 20 Hz
  constexpr std::size_t kLeast_hz = 4;  // with less there is nothing to tell effects by
  std::array<JointPower, static_cast<std::size_t>(kHighest_hz)> bands;
  JointPower quiet;
  const auto visit = [&](const Eigen::VectorXcd& torque, const Eigen::VectorXcd& angle) {
    for (Eigen::Index k = 1; k < angle.size() / 2; ++k) {
      const double hz = kResampledRateHz * static_cast<double>(k) / kPieceRows;
      const std::complex<double> in_time = angle[k] * std::polar(1.0, 2 * std::numbers::pi * hz * late_s);
      if (hz < kHighest_hz) bands[static_cast<std::size_t>(hz)].add(torque[k], in_time);
      if (hz >= kQuiet_hz && hz < kQuietEnd_hz) quiet.add(torque[k], in_time);
    }
  };
  for_each_piece(record, torque_nm, record.angle_rad, visit);
  DrivenBand out;
  out.noise_alone_above = !(quiet.coherence() > kTogether);
  if (out.noise_alone_above || !(quiet.power() < kTakesOut)) return out;
  std::size_t end = bands.size();
  while (end > kLeast_hz && bands[end - 1].power() < 0) --end;
  out.highest_hz = static_cast<double>(end);
  return out;
}

}  // namespace

DrivenBand driven_band(const Record& record, double pass_hz, double late_s) {
  DrivenBand out;
  if (kQuietEnd_hz > pass_hz) return out;
  std::vector<double> motor_nm = record.torque_motor_nm;
  for (double& torque : motor_nm) torque = -torque;
  for (const std::vector<double>& torque : {record.net_torque_nm(), record.torque_driver_nm, motor_nm}) {
    const DrivenBand one = drives(record, torque, late_s);
    out.highest_hz = std::min(out.highest_hz, one.highest_hz);
    out.noise_alone_above = out.noise_alone_above && one.noise_alone_above;
  }
  return out;
}

}  // namespace steerid::gap
