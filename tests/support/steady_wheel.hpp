// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel in steady state under a sum of sines: torque and angle in closed form, theta = T / (C - J w^2 + i B w).
// Shares no code with the plant, the fit or the identifier.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace steerid::test {

struct Tone {
  double hz = 1.0;
  double amplitude_nm = 1.0;
  double phase_rad = 0.0;
};

struct SteadyWheel {
  double inertia_kgm2 = 0.11;
  double damping_nms_per_rad = 1.5;
  double stiffness_nm_per_rad = 22.7;
  std::vector<Tone> tones;

  [[nodiscard]] double torque_nm(double t_s) const {
    double sum = 0;
    for (const Tone& tone : tones) {
      sum += tone.amplitude_nm * std::cos(2 * std::numbers::pi * tone.hz * t_s + tone.phase_rad);
    }
    return sum;
  }

  [[nodiscard]] double angle_rad(double t_s) const {
    double sum = 0;
    for (const Tone& tone : tones) {
      const double w = 2 * std::numbers::pi * tone.hz;
      const std::complex<double> stiffness(stiffness_nm_per_rad - inertia_kgm2 * w * w, damping_nms_per_rad * w);
      sum += (tone.amplitude_nm / stiffness * std::polar(1.0, w * t_s + tone.phase_rad)).real();
    }
    return sum;
  }

  /// 0.2 to 5 Hz every 0.2 Hz with Schroeder's phases, 1.5 Nm rms.
  static std::vector<Tone> probe() {
    std::vector<Tone> tones;
    for (int k = 1; k <= 25; ++k) {
      tones.push_back({0.2 * k, 1.5 * std::sqrt(2.0 / 25), -std::numbers::pi * k * (k - 1) / 25});
    }
    return tones;
  }
};

}  // namespace steerid::test
