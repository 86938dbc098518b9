// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/parts_response.hpp"

#include <algorithm>
#include <complex>
#include <iterator>

#include "gap/model/spectral_model.hpp"

namespace steerid::gap {

double set_parts_response(std::span<const Hypothesis* const> parts, const Eigen::VectorXd& x,
                          const Eigen::VectorXd& omega, Response& out) {
  WheelArm wheel = wheel_of(x);
  // A wheel without a spring has no response at zero frequency: a spring far below what a record can show.
  wheel.stiffness_nm_per_rad = std::max(wheel.stiffness_nm_per_rad, 1e-3 * wheel.inertia_kgm2);
  out.gain.resize(omega.size());
  for (Eigen::Index k = 0; k < omega.size(); ++k) out.gain[k] = wheel_response(wheel, omega[k]);
  out.ends = out.gain;
  const bool several = parts.size() > 1;
  const Spectrum plain = several ? out.gain : Spectrum();
  out.late = Spectrum::Constant(omega.size(), 1.0);
  double delay_s = 0;
  const double* values = x.data() + 3;
  for (const Hypothesis* part : parts) {
    delay_s += part->delay_s(values);
    for (Eigen::Index k = 0; !part->acts() && k < omega.size(); ++k) {
      const Complex own = part->response(wheel, values, omega[k]);
      const Complex ends = part->ends(wheel, values, omega[k]);
      if (part->on_channel() && several) {
        out.late[k] *= own / plain[k];
      } else {
        out.gain[k] = several ? out.gain[k] * own / plain[k] : own;
      }
      out.ends[k] = several ? out.ends[k] * ends / plain[k] : ends;
    }
    values += part->type().parameters.size();
  }
  return delay_s;
}

Eigen::VectorXd felt_by_noise(std::span<const Hypothesis* const> parts, Eigen::VectorXd x,
                              const MeasuredMotion& motion) {
  Eigen::Index at = 3;
  for (const Hypothesis* part : parts) {
    const WheelArm added = part->felt_by_noise(x.data() + at, motion);
    x.head(3) += Eigen::Vector3d(added.inertia_kgm2, added.damping_nms_per_rad, added.stiffness_nm_per_rad);
    at += std::ssize(part->type().parameters);
  }
  return x;
}

void delay(Spectrum& spectrum, const Eigen::VectorXd& omega, double by_s) {
  for (Eigen::Index k = 0; by_s != 0 && k < omega.size(); ++k) spectrum[k] *= std::polar(1.0, -omega[k] * by_s);
}

}  // namespace steerid::gap
