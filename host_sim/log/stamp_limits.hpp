// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a log's stamps may be, and in which unit they are where they may not be that in seconds.
#pragma once

#include <string>

namespace steerid {

/// The farthest stamp from zero, s. A double there still tells 2 us apart; an epoch in seconds is 2e9.
inline constexpr double kLatestTimeS = 1e10;

/// Rows a second, at least.
inline constexpr double kLowestRateHz = 50.0;

/// The coarsest of ms, us and ns in which a stamp and the distance between two are a log's; ns where none is.
/// `apart` is 0 where it is not known.
[[nodiscard]] std::string likely_time_unit(double stamp, double apart);

}  // namespace steerid
