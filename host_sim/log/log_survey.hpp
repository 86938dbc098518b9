// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What stands in every column of a log, whether it is a channel or not.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "log/log_source.hpp"

namespace steerid {

struct ColumnSurvey {
  std::size_t column = 0;  ///< index into LogSource::columns()
  std::size_t values = 0;  ///< that are numbers
  double rate_hz = 0.0;    ///< one over the median step between them; 0 without stamps
  std::size_t gaps = 0;    ///< steps that are gaps (log/record_quality.hpp)
  double low = 0.0;
  double high = 0.0;
  bool whole_numbers = false;  ///< all of them, as counts are
};

/// Reads the rest of the log. `time`, when there is one, is no column of the survey. Text counts as missing. Throws
/// BadInput where the file is not of its format, or its clock goes back.
[[nodiscard]] std::vector<ColumnSurvey> survey_columns(LogSource& source, const std::optional<WantedColumn>& time);

}  // namespace steerid
