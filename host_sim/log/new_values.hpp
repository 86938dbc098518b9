// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The values at which a channel changes: what a logger that keeps the last message shows of the messages.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace steerid {

struct NewValues {
  std::vector<std::size_t> row{};  ///< ascending; the first row is new
  std::vector<double> value{};
};

[[nodiscard]] inline NewValues new_values(std::span<const double> values) {
  NewValues out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && values[i] == values[i - 1]) continue;
    out.row.push_back(i);
    out.value.push_back(values[i]);
  }
  return out;
}

}  // namespace steerid
