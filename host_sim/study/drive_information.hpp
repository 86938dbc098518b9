// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a drive could tell of J, B and C at any time: the Fisher information of its samples, block by block.
//
// With Gaussian noise of known statistics the information of the samples up to now is the sum of s s' / S over them,
// s the sensitivity of the sample's innovation to (J, B, C) and S its variance. The innovation is that of the Kalman
// filter for the wheel at its true parameters, with the states
//
//   th, th'    moved by the measured torque, whose sensor noise acts on the wheel as white process noise,
//   u, u'      the torque that no sensor sees: u'' + 2 w0 u' + w0^2 u = white noise (experiment/smooth_noise.hpp),
//
// and the angle with white noise measured. Parameters enter through the free run on the measured torque, so that s is
// what the same filter leaves of d th/d(J, B, C) (plant/linear_response.hpp). Where the wheel starts is taken for
// unknown. The inverse is the Cramer-Rao bound. Left out is what the colour of the unmeasured torque's own answer tells
// of the wheel: no estimator here uses it. Nothing is shared with the recursive identifier.
//
// Cost: some 100 ns a tick.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "plant/wheel_arm.hpp"

namespace steerid {

/// What stands between the truth and the record; standard deviations of white noise, and the unmeasured torque.
struct DriveNoise {
  double angle_rad = 0;
  double torque_nm = 0;      ///< of driver's and motor's sensor together
  double unmeasured_nm = 0;  ///< rms
  double unmeasured_corner_hz = 0.3;
};

/// Information on J, B, C (SI units) of each `block` ticks, in order; a rest shorter than a block is left out.
/// `torque_nm[k]` is T_driver - T_motor at tick k, without the sensors' noise. The wheel is at rest at the first tick.
[[nodiscard]] std::vector<Eigen::Matrix3d> information_by_block(const WheelArm& wheel,
                                                                std::span<const double> torque_nm,
                                                                const DriveNoise& noise, std::size_t block);

/// The Cramer-Rao standard deviations of J, B and C; infinite where there is no information.
[[nodiscard]] Eigen::Vector3d bound_of(const Eigen::Matrix3d& information);

}  // namespace steerid
