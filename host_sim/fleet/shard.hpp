// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One part of many that a list of records is divided into. A record's part follows from its own path alone: the first
// 16 hexadecimal digits of the path's SHA-256, as a number, modulo the number of parts. A record that is added or taken
// away moves no other.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace steerid::fleet {

struct Shard {
  std::size_t number = 1;  ///< 1 to `of`
  std::size_t of = 1;

  /// `record_path` is that of the record's log in its folder, with '/'.
  [[nodiscard]] bool holds(std::string_view record_path) const;
  /// "3/10"
  [[nodiscard]] std::string text() const;
};

/// Of "3/10". Throws BadOption.
[[nodiscard]] Shard parse_shard(std::string_view text);

}  // namespace steerid::fleet
