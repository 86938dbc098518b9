// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The response, torque to recorded angle, of a wheel with effects of which some are linear: what shapes noise, slow
// torque and block ends, whether the effects' own torques are worked out on the measured motion or run.
#pragma once

#include <Eigen/Core>
#include <span>

#include "gap/hypotheses/hypothesis.hpp"
#include "gap/likelihood/whittle.hpp"

namespace steerid::gap {

/// Sets `out` at the lines `omega`, rad/s, for x = J, B, C and the parts' values, one after the other; returns the
/// parts' delay, s, which is not in out.late. A single part on the angle's channel is in out.gain; beside others it is
/// in out.late, for what they do depends on the angle before it.
double set_parts_response(std::span<const Hypothesis* const> parts, const Eigen::VectorXd& x,
                          const Eigen::VectorXd& omega, Response& out);

/// x with the J, B and C that a small movement beside the motion meets.
[[nodiscard]] Eigen::VectorXd felt_by_noise(std::span<const Hypothesis* const> parts, Eigen::VectorXd x,
                                            const MeasuredMotion& motion);

/// Makes a spectrum late.
void delay(Spectrum& spectrum, const Eigen::VectorXd& omega, double by_s);

}  // namespace steerid::gap
