// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

#include <array>

namespace steerid {

/// The weights of a logistic function of `calibration_inputs` (gap/sets/inclusion.cpp):
/// constant, odds, left, share, shift, revision. 272 questions; prior deviation 2.
inline constexpr std::array<double, 6> kInclusionCalibration = {-5.167, 0.6379, -1.343, 0.3321, -0.0005916, -0.2651};

}  // namespace steerid
