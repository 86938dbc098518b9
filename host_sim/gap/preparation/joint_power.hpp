// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Torque and angle together over some Fourier lines: how much of each the other explains, and which way power flows.
#pragma once

#include <complex>

namespace steerid::gap {

struct JointPower {
  std::complex<double> cross = 0;
  double torque = 0;
  double angle = 0;

  void add(const std::complex<double>& t, const std::complex<double>& a) {
    cross += t * std::conj(a);
    torque += std::norm(t);
    angle += std::norm(a);
  }
  [[nodiscard]] double coherence() const { return std::norm(cross) / (torque * angle); }
  /// Of what torque and angle could carry, -1 to 1: the sine of the torque's lead. Above 0 the torque drives.
  [[nodiscard]] double power() const { return cross.imag() / std::abs(cross); }
};

}  // namespace steerid::gap
