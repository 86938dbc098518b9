// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/slow_in_run.hpp"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "gap/hypotheses/hypothesis.hpp"

namespace steerid {

double slow_share_of_run(const SpectralRecord& record, const Whittle& whittle, SimulatedModel& model,
                         const Whittle::Fit& fit) {
  constexpr double kSlow_hz = 1;
  const std::span<const double> run_rad = model.run(fit.x);
  if (run_rad.empty()) return 0;
  std::vector<double> left_rad(record.record.angle_rad);
  for (std::size_t i = 0; i < left_rad.size(); ++i) left_rad[i] -= run_rad[i];
  const Spectrum left = record.spectra.of(left_rad);
  const WheelArm wheel = wheel_of(fit.x);
  double square = 0;
  double samples = 0;
  for (const BlockSpectra::Bins& bins : record.spectra.blocks()) {
    if (!is_among(kSeen, bins.block.role)) continue;
    samples += static_cast<double>(bins.block.count);
    for (Eigen::Index k = bins.first; k < bins.first + bins.count; ++k) {
      const double w = record.spectra.omega()[k];
      if (w > 2 * std::numbers::pi * kSlow_hz) break;
      const double gain = std::norm(wheel_response(wheel, w));
      const double white =
          fit.floor.angle_density(record.spectra, k) / gain + fit.floor.torque_density(record.spectra, k);
      square += (k == bins.first ? 1 : 2) * (std::norm(left[k]) / gain - white);
    }
  }
  return std::sqrt(std::max(square, 0.0) / samples) / whittle.applied_rms_nm();
}

}  // namespace steerid
