// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

#include <array>

namespace steerid {

/// The weights of a logistic function of `calibration_inputs` (gap/sets/inclusion.cpp):
/// constant, odds, left, share, shift, revision, discrepancy. 335 questions; prior deviation 0.5.
inline constexpr std::array<double, 7> kInclusionCalibration = {-4.281, 0.8247, -0.8558, 0.182, -0.4633, 0, -0.7468};

}  // namespace steerid
