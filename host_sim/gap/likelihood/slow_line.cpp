// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/likelihood/slow_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace steerid {

double slow_line_share(const Whittle& whittle, ResidualModel& model, const Whittle::Fit& fit) {
  constexpr std::size_t kFewest = 20;  // lines
  constexpr double kHalfWidth = 1.5;   // lines
  struct Line {
    double f_hz;
    double apart_hz;  // from the next line of its block
    double power;     // over what is expected
  };
  std::vector<Line> lines;
  Spectrum residual;
  Response response;
  model.evaluate(fit.x, residual, response);
  const BlockSpectra& spectra = whittle.spectra();
  const Spectrum left = Whittle::Whitened(spectra, response, fit.floor, kSeen).without_ends(residual);
  const Eigen::VectorXd gain = response.gain.cwiseAbs2();
  const Eigen::VectorXd density = fit.floor.density(spectra, gain);
  const auto hz = [&](Eigen::Index bin) { return spectra.omega()[bin] / (2 * std::numbers::pi); };
  double sum = 0;
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    if (!is_among(kSeen, bins.block.role)) continue;
    for (Eigen::Index k = bins.first + 1; k < bins.first + bins.count; ++k) {
      if (gain[k] * fit.floor.slow_variance * fit.floor.slow_shape(hz(k)) < density[k] / 2) continue;
      lines.push_back({hz(k), hz(k) - hz(k - 1), std::norm(left[k]) / density[k]});
      sum += lines.back().power;
    }
  }
  if (lines.size() < kFewest) return 0;
  double most = 0;
  for (const Line& middle : lines) {
    double near = 0;
    for (const Line& one : lines) {
      if (std::abs(one.f_hz - middle.f_hz) <= kHalfWidth * one.apart_hz) near += one.power;
    }
    most = std::max(most, near);
  }
  return most / sum;
}

}  // namespace steerid
