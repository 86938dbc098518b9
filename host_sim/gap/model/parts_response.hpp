// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The response, torque to recorded angle, of a wheel with effects of which some are linear: what shapes noise, slow
// torque and block ends, whether the effects' own torques are worked out on the measured motion or run.
#pragma once

#include <Eigen/Core>

#include "gap/likelihood/whittle.hpp"
#include "gap/model/point.hpp"

namespace steerid::gap {

/// Sets `out` at the lines `omega`, rad/s; returns the effects' delay, s, which is not in out.late.
double set_parts_response(const Point& at, const Eigen::VectorXd& omega, Response& out);

/// With the J, B and C that a small movement beside the motion meets.
[[nodiscard]] Point felt_by_noise(Point at, const MeasuredMotion& motion);

/// Makes a spectrum late.
void delay(Spectrum& spectrum, const Eigen::VectorXd& omega, double by_s);

}  // namespace steerid::gap
