// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How a CSV file is laid out, by its first lines.
//
// The separator is the comma, semicolon or tab with which a line of names stands above a row of numbers, with as many
// cells; of several the one that makes most cells. Lines above the names (Excel's "sep=;", a title, CANape's preamble)
// are passed over; lines of text between the names and the first row are looked at for units. A row of numbers has
// numbers or time stamps in at least half of the cells that are not empty. Where nothing fits, the first line has the
// names.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace steerid {

struct CsvDialect {
  char separator = ',';
  std::size_t header = 0;     ///< the line with the names, an index into the lines given
  std::size_t first_row = 1;  ///< the first line of numbers

  /// A comma inside a number is a decimal comma where it does not separate cells.
  [[nodiscard]] bool decimal_comma() const { return separator != ','; }
};

inline constexpr std::size_t kLinesToJudgeBy = 50;

/// `lines` are the file's first ones that are neither blank nor comments; at least one.
[[nodiscard]] CsvDialect dialect_of(const std::vector<std::string>& lines);

/// Comma, semicolon or tab: the one that a line of names alone holds most of outside quotes.
[[nodiscard]] char detect_separator(std::string_view line);

/// The cells of a line; `broken` when a quote does not close.
[[nodiscard]] std::vector<std::string> cells_of(std::string_view line, char separator, bool& broken);

/// A cell that stands for a value that was not measured: empty, NaN, NA, N/A, null, none.
[[nodiscard]] bool is_missing(std::string_view cell);

}  // namespace steerid
