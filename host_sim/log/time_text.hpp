// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Time stamps that are written as a date and a time of day, as spreadsheets and loggers write them.
//
//   2026-11-25T13:26:19.123456Z      ISO 8601: a T or a blank between, . or , before the fraction, Z, +01:00, +0100 or
//   2026-11-25 13:26:19,123          nothing behind it (then it is taken as UTC: only differences matter)
//   25.11.2026 13:26:19.123          day first with dots, as in Germany; 25/11/2026 is refused: it may be either
//   25-Nov-2026 13:26:19.123         MATLAB's datetime
//   13:26:19.123                     time of day alone
//   0.01 sec                         MATLAB's duration
#pragma once

#include <optional>
#include <string_view>

namespace steerid {

/// Seconds since 1970-01-01 (since midnight for a time of day alone, the number itself for a duration in seconds);
/// nothing when the text is none of the above. A double there tells 0.24 us apart.
[[nodiscard]] std::optional<double> seconds_of(std::string_view text);

}  // namespace steerid
