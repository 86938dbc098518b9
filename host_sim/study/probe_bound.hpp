// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the probe lets know of an arm whose driver's own torque nobody measures: information and bound, block by block.
//
//   T = J th'' + B th' + C th + e        T: what the torsion bar says, its sign turned
//   e = -Tv + torque noise + (J s2 + B s + C) angle noise,   s2, s: second and first derivative
//
// Only the motion that the probe causes, z, is independent of e. An estimator that knows the spectrum of e and uses
// that motion alone learns from a tick
//
//   I_ij = w_i w_j,     w = (z'', z', z) behind the filter that makes e white noise of variance 1
//
// (Ljung, System Identification, 1999, sections 7.4 and 9.4; Soederstroem and Stoica 1983 for the instrument). The
// inverse of the sum is the bound here, "by the probe". It is no Cramer-Rao bound of the whole record: a filter that
// knows the driver's spectrum exactly can use the motion that he causes himself, which no instrument can.
//
// z is half the difference of two simulations of one drive, one under the probe and one under its negative: exact where
// the column is linear, and what remains when friction and dead zone answer the driver otherwise. The whitening filter
// is the predictor of order 64 of the density of e (Levinson and Durbin's recursion on its autocovariance).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "plant/wheel_arm.hpp"

namespace steerid {

/// What hides the arm. Densities are one-sided, white noise is a sample's at 100 Hz.
struct HidingNoise {
  std::function<double(double hz)> intent_rad2_per_hz;  ///< of the angle that the driver means, Tv / C
  double torque_noise_nm = 0;
  double angle_noise_rad = 0;
};

/// Of a process of second order, critically damped: flat up to its corner, 40 dB a decade down above.
[[nodiscard]] double smooth_density(double rms, double corner_hz, double hz);

/// Information on J, B and C (SI units) of each block of `block` ticks, in order; what is shorter at the end is left
/// out. `by_probe_rad` is z, a value a tick, `arm` the truth beside it.
[[nodiscard]] std::vector<Eigen::Matrix3d> probe_information(std::span<const double> by_probe_rad,
                                                             std::span<const WheelArm> arm, const HidingNoise& noise,
                                                             std::size_t block);

/// Which blocks an estimator may use at any block.
enum class Uses : std::uint8_t { kPast, kPastAndFuture };

/// Standard deviations of J, B and C after every block, of an estimator that knows how they walk: by a step of variance
/// `walk` (a parameter's unit squared) from block to block, each parameter by itself. 0: an arm that is known to stay.
[[nodiscard]] std::vector<Eigen::Vector3d> followed_bound(std::span<const Eigen::Matrix3d> information,
                                                          const Eigen::Vector3d& walk, Uses uses);

}  // namespace steerid
