// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Stamps as people read them. A date as seconds since 1970 has ten digits before its point, of which a chart's axis and
// a line of text show none that tell two samples apart: of such a clock the time is given from the record's beginning.
// Files keep the stamps of their log.
#pragma once

#include <vector>

namespace steerid {

/// What is taken off the stamps of a record that begins at `first_s`: itself where it is a date, which is after 1973
/// (no clock that counts from its own start has run for three years); else 0.
[[nodiscard]] constexpr double reading_zero_s(double first_s) {
  constexpr double kDateS = 1e8;
  return first_s >= kDateS ? first_s : 0.0;
}

/// The stamps less `zero_s`.
[[nodiscard]] inline std::vector<double> reading_times(std::vector<double> time_s, double zero_s) {
  for (double& stamp : time_s) stamp -= zero_s;
  return time_s;
}

}  // namespace steerid
