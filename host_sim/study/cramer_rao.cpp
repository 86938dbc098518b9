// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/cramer_rao.hpp"

#include <Eigen/LU>
#include <complex>
#include <numbers>

namespace steerid {

Eigen::Matrix3d cramer_rao_bound(const SteadyDrive& drive) {
  using Complex = std::complex<double>;
  const WheelArm& wheel = drive.wheel;
  const double angle_power =
      drive.angle_noise_rad * drive.angle_noise_rad + drive.angle_step_rad * drive.angle_step_rad / 12;
  const double tone_power = drive.tone_nm() * drive.tone_nm() / 2;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (int k = kFirstTone; k <= kLastTone; ++k) {
    const double f = k / kProbePeriod_s;
    const Complex s(0, 2 * std::numbers::pi * f);
    const Complex gain =
        1.0 / (wheel.inertia_kgm2 * s * s + wheel.damping_nms_per_rad * s + wheel.stiffness_nm_per_rad);
    const double torque_power = drive.torque_noise_nm * drive.torque_noise_nm + unmeasured_density(drive, f);
    const double spectrum = angle_power + std::norm(gain) * torque_power;
    const Eigen::Vector3cd by = -gain * gain * Eigen::Vector3cd(s * s, s, Complex(1));
    information += static_cast<double>(drive.samples) * tone_power / spectrum * (by * by.adjoint()).real();
  }
  // Scaled to relative changes of the parameters, where it is well conditioned.
  const Eigen::DiagonalMatrix<double, 3> scale(wheel.inertia_kgm2, wheel.damping_nms_per_rad,
                                               wheel.stiffness_nm_per_rad);
  const Eigen::Matrix3d scaled = scale * information * scale;
  return scale * scaled.inverse() * scale;
}

}  // namespace steerid
