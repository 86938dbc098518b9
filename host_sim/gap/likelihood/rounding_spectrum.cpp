// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/rounding_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steerid::gap {
namespace {

/// The mean over the neighbours of every line of a block: a motion that is off by a few per cent has the lines of its
/// saw-teeth off by as much.
Eigen::VectorXd mean_of_neighbours(const Eigen::VectorXd& power) {
  constexpr double kReach = 0.15;  // of a line's frequency
  constexpr Eigen::Index kFewest = 2;
  const Eigen::Index n = power.size();
  Eigen::VectorXd sum(n + 1);
  sum[0] = 0;
  for (Eigen::Index k = 0; k < n; ++k) sum[k + 1] = sum[k] + power[k];
  Eigen::VectorXd out(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index reach = std::max(kFewest, static_cast<Eigen::Index>(kReach * static_cast<double>(k)));
    const Eigen::Index first = std::max<Eigen::Index>(k - reach, 0);
    const Eigen::Index end = std::min(k + reach + 1, n);
    out[k] = (sum[end] - sum[first]) / static_cast<double>(end - first);
  }
  return out;
}

}  // namespace

Eigen::VectorXd rounding_spectrum(const BlockSpectra& spectra, std::span<const double> motion_rad, double step_rad) {
  constexpr int kPlaces = 16;  // within a step
  Eigen::VectorXd power = Eigen::VectorXd::Zero(spectra.bins());
  std::vector<double> error_rad(motion_rad.size());
  for (int place = 0; place < kPlaces; ++place) {
    const double offset = (place + 0.5) / kPlaces;
    for (std::size_t i = 0; i < error_rad.size(); ++i) {
      const double steps = motion_rad[i] / step_rad + offset;
      error_rad[i] = step_rad * (std::round(steps) - steps);
    }
    power += spectra.of(error_rad).cwiseAbs2() / kPlaces;
  }
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    power.segment(bins.first, bins.count) = mean_of_neighbours(power.segment(bins.first, bins.count));
  }
  return power;
}

}  // namespace steerid::gap
