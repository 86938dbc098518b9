// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable a change is. Set by hand on labelled records: no calibration yet.
#pragma once

#include <array>

namespace steerid {

/// The weights of a logistic function whose inputs are those of `calibration_inputs` (gap/sets/inclusion.cpp).
inline constexpr std::array<double, 5> kInclusionCalibration = {-14.9, 2.0, -3.0, 0.3, -0.8};

}  // namespace steerid
