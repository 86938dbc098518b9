// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dates of a list of records.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace steerid::fleet {

/// Days since 1970-01-01 of "2026-05-01", "2026-05-01T13:45" or "2026-05-01T13:45:30Z"; nothing of anything else. A
/// time without a zone counts as UTC.
[[nodiscard]] std::optional<double> days_of(std::string_view iso_8601);

/// "2026-05-01" of any instant of that day.
[[nodiscard]] std::string date_of(double days);

}  // namespace steerid::fleet
