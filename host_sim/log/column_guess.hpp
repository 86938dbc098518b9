// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which of a log's columns a channel probably is, by the words in their names and by their units. Only proposed, never
// taken: a wrong guess would be a wrong number.
//
//   score = 3 for a word that means this channel ("lenkwinkel", "torsion"), 1 for one that may ("torque", "position"),
//           2 more when the unit is one of the channel's quantity, 4 less when it is one of another
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "log/log_format.hpp"
#include "log/log_source.hpp"

namespace steerid {

/// How much a column looks like a channel; 2 and more is worth naming.
[[nodiscard]] int likeness(const LogColumn& column, Channel channel);
inline constexpr int kWorthNaming = 2;

/// For each channel the column that looks most like it, each column once, the surest first; nothing where none does.
[[nodiscard]] std::array<std::optional<std::size_t>, kChannels> likely_columns(const std::vector<LogColumn>& columns);

}  // namespace steerid
