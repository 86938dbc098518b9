// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/parts_response.hpp"

#include <algorithm>
#include <complex>

namespace steerid::gap {

double set_parts_response(const Point& at, const Eigen::VectorXd& omega, Response& out) {
  const WheelArm wheel = with_a_spring(at.wheel);
  out.gain.resize(omega.size());
  for (Eigen::Index k = 0; k < omega.size(); ++k) out.gain[k] = wheel_response(wheel, omega[k]);
  out.ends = out.gain;
  const bool several = at.effects.size() > 1;
  const Spectrum plain = several ? out.gain : Spectrum();
  out.late = Spectrum::Constant(omega.size(), 1.0);
  out.on_wheel.resize(0);
  double delay_s = 0;
  for (const Effect& effect : at.effects) {
    const Hypothesis* part = hypothesis_of(*effect.type);
    const double* values = effect.values.data();
    delay_s += part->delay_s(values);
    if (part->on_channel() && out.on_wheel.size() == 0) out.on_wheel = out.gain;
    const bool on_wheel = !part->on_channel() && out.on_wheel.size() > 0;
    for (Eigen::Index k = 0; !part->acts() && k < omega.size(); ++k) {
      const Complex own = part->response(wheel, values, omega[k]);
      const Complex ends = part->ends(wheel, values, omega[k]);
      out.gain[k] = several ? out.gain[k] * own / plain[k] : own;
      if (on_wheel) out.on_wheel[k] *= own / plain[k];
      out.ends[k] = several ? out.ends[k] * ends / plain[k] : ends;
    }
  }
  return delay_s;
}

Point felt_by_noise(Point at, const MeasuredMotion& motion) {
  for (const Effect& effect : at.effects) {
    const WheelArm added = hypothesis_of(*effect.type)->felt_by_noise(effect.values.data(), motion);
    at.wheel.inertia_kgm2 += added.inertia_kgm2;
    at.wheel.damping_nms_per_rad += added.damping_nms_per_rad;
    at.wheel.stiffness_nm_per_rad += added.stiffness_nm_per_rad;
  }
  return at;
}

void delay(Spectrum& spectrum, const Eigen::VectorXd& omega, double by_s) {
  for (Eigen::Index k = 0; by_s != 0 && k < omega.size(); ++k) spectrum[k] *= std::polar(1.0, -omega[k] * by_s);
}

}  // namespace steerid::gap
