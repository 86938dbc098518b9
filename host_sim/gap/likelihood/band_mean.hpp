// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The mean of a density over a band of frequencies.
#pragma once

namespace steerid::gap {

/// Mean of `density(f_hz)` from `low_hz` to `high_hz`, by the midpoint rule: a band of 50 Hz in lines of 0.0125 Hz, an
/// eighth of the narrowest colour that a slow torque may have. Costs as many evaluations as there are lines.
template <class Density>
[[nodiscard]] double band_mean(double low_hz, double high_hz, const Density& density) {
  constexpr int kLines = 4000;
  const double step_hz = (high_hz - low_hz) / kLines;
  double sum = 0;
  for (int k = 0; k < kLines; ++k) sum += density(low_hz + (k + 0.5) * step_hz);
  return sum / kLines;
}

}  // namespace steerid::gap
