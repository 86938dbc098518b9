// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The tests' own wheel, an oracle that shares no code with the plant: J th'' + B th' + C th = T by the classical
// Runge-Kutta method in small equal steps.
#pragma once

#include <vector>

#include "plant/wheel_arm.hpp"

namespace steerid::test {

/// The angle at the start of each of `ticks` ticks of 10 ms, from rest at 0, in `steps` steps a tick. net(k, tau) is
/// the torque in tick k, tau seconds after its start.
template <class NetTorque>
std::vector<double> independent_angles(const WheelArm& arm, std::size_t ticks, int steps, NetTorque net) {
  std::vector<double> out;
  double angle = 0;
  double rate = 0;
  const double h = 0.01 / steps;
  for (std::size_t k = 0; k < ticks; ++k) {
    out.push_back(angle);
    for (int i = 0; i < steps; ++i) {
      const auto acceleration = [&](double tau, double a, double r) {
        return (net(k, tau) - arm.damping_nms_per_rad * r - arm.stiffness_nm_per_rad * a) / arm.inertia_kgm2;
      };
      const double tau = i * h;
      const double k1 = acceleration(tau, angle, rate);
      const double k2 = acceleration(tau + h / 2, angle + h / 2 * rate, rate + h / 2 * k1);
      const double k3 = acceleration(tau + h / 2, angle + h / 2 * (rate + h / 2 * k1), rate + h / 2 * k2);
      const double k4 = acceleration(tau + h, angle + h * (rate + h / 2 * k2), rate + h * k3);
      angle += h * (rate + h / 6 * (k1 + k2 + k3));
      rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return out;
}

}  // namespace steerid::test
