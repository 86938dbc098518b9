// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The Cramer-Rao bound of a steady drive, in the frequency domain: what no unbiased estimator can do better than.
//
// The residual angle - G torque of a long record has the spectrum S(f) = s_th^2 + |G(f)|^2 (s_u^2 + D(f)): the angle's
// noise, and, through the wheel, the torque sensor's noise and the density of the torque that no sensor sees. At the
// probe's tones, amplitude a, the answer moves with a parameter by a dG/dp, so that N samples hold the information
//
//   I_ij = sum over tones  N a^2/2  Re(dG/dp_i conj dG/dp_j) / S,      dG/d(J, B, C) = -G^2 (s^2, s, 1),  s = i w
//
// and the bound is I^-1. Derivation: docs/testing.md. The record is taken for a steady state whose initial angle and
// rate are unknown, which costs a term of order (memory of the wheel)/(length of the record), left out here; and the
// resolution is taken for white noise of a twelfth of its square.
#pragma once

#include <Eigen/Core>

#include "study/steady_drive.hpp"

namespace steerid {

/// Covariance of J, B, C (SI units, in this order) that no unbiased estimator can go below.
[[nodiscard]] Eigen::Matrix3d cramer_rao_bound(const SteadyDrive& drive);

}  // namespace steerid
