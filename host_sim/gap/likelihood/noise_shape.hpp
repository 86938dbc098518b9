// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether what is taken for a sensor's noise is one.
//
// The floor's level is read off above 15 Hz, where no wheel moves, and believed. But something that follows the motion
// may stand there: the rounding of a coarse angle, samples that are lost, a sensor with play. Then a fit that reaches
// the floor has explained nothing. A sensor's noise is the sum of many small causes, and normal; those are not.
#pragma once

#include <span>

#include "log/record.hpp"

namespace steerid {

/// Deviations from which on it is more likely none: normal noise makes 4 in a record of 300, a rounded angle 9 and
/// more.
inline constexpr double kNoNoise = 6;

/// How far what a free run leaves of the angle is from normal above 15 Hz: of kurtosis and of Geary's ratio of mean to
/// root mean square size (Geary 1935) the one that is further off, in deviations that chance makes. 0 where there is
/// too little to tell. `run_rad` has one angle a sample of a record at 100 Hz; samples in which it is not finite are
/// left out.
[[nodiscard]] double departure_from_normal(const Record& record, std::span<const double> run_rad);

}  // namespace steerid
