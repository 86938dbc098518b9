// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How much fast torque (gap/likelihood/fast_torque.hpp) a fit leaves in its lines.
//
// A driver's own torque is not coherent with the applied one; what a set of changes lacks mostly is. So every line
// counts only as far as its neighbours do not predict it from the drive (Pintelon and Schoukens, System Identification,
// 2012, section 7.2: the local polynomial method, of order zero).
#pragma once

#include "gap/likelihood/whittle.hpp"

namespace steerid::gap {

/// `drive`: the applied torque's lines; `slow`: as the fit had it. None where the lines do not speak strongly for it,
/// and where a driver steers, whose own torque is measured beyond his band as it is (NoiseFloor::steering_tail_nm).
[[nodiscard]] FastTorque fast_torque_left(const Whittle& whittle, const Spectrum& drive, const Whittle::Fit& fit,
                                          SlowTorque slow, const Whittle::Roles& roles);

}  // namespace steerid::gap
