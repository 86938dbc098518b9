// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/torque_lines.hpp"

#include <numbers>
#include <vector>

namespace steerid::gap {

TorqueLines::TorqueLines(const BlockSpectra& spectra, const Whittle::Roles& roles, NoiseFloor floor,
                         const Response& response, const Eigen::VectorXd& left, const Eigen::VectorXd& known,
                         double top_hz) {
  constexpr double kLeastKnown = 0.02;
  std::vector<Eigen::Index> at;
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    if (!is_among(roles, bins.block.role)) continue;
    for (Eigen::Index bin = bins.first; bin < bins.first + bins.count; ++bin) {
      if (spectra.omega()[bin] > 2 * std::numbers::pi * top_hz) break;
      if (known[bin] >= kLeastKnown) at.push_back(bin);
    }
  }
  f_hz = spectra.omega()(at).array() / (2 * std::numbers::pi);
  gain = response.gain(at).cwiseAbs2();
  power = left(at).array() / known(at).array();
  weight = known(at);
  weight = (f_hz > 0).select(weight, weight / 2);  // the line at zero is real: half a line
  floor.slow_variance = 0;
  white = floor.density(spectra, response.gain.cwiseAbs2())(at);
}

double TorqueLines::cost(const Eigen::ArrayXd& torque_density) const {
  const Eigen::ArrayXd density = white + gain * torque_density;
  return (weight * (density.log() + power / density)).sum();
}

}  // namespace steerid::gap
