// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Written by scripts/calibrate_inclusion.py; what it was fitted to and how reliable it is:
// docs/results/inclusion_calibration.md.
#pragma once

#include "gap/sets/inclusion.hpp"

namespace steerid::gap {

/// 989 questions.
inline constexpr InclusionCalibration kInclusionCalibration = {-2.706, 1.647, -0.7154, 6.985, 0.1, 0.001};

}  // namespace steerid::gap
