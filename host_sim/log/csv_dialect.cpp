// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/csv_dialect.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "log/csv_lines.hpp"
#include "log/text.hpp"
#include "log/time_text.hpp"

namespace steerid {
namespace {

struct Layout {
  CsvDialect dialect{};
  std::size_t cells = 0;
};

bool is_row(const std::vector<std::string>& cells, bool decimal_comma) {
  std::size_t numbers = 0;
  std::size_t others = 0;
  for (const std::string& cell : cells) {
    if (is_missing(cell)) continue;
    double value = 0;
    ++(is_number(cell, decimal_comma, value) || seconds_of(cell) ? numbers : others);
  }
  return numbers > 0 && numbers >= others;
}

/// A row may end with a separator that the line of names has not.
bool as_many(const std::vector<std::string>& names, const std::vector<std::string>& row) {
  return row.size() == names.size() || (row.size() == names.size() + 1 && row.back().empty());
}

/// Of the rows that stand below names the first of the widest: a preamble may look like a table too.
std::optional<Layout> layout_with(char separator, const std::vector<std::string>& lines) {
  std::optional<Layout> widest;
  const bool decimal_comma = CsvDialect{.separator = separator}.decimal_comma();
  std::vector<std::vector<std::string>> cells;
  for (const std::string& line : lines) {
    bool broken = false;
    cells.push_back(cells_of(line, separator, broken));
    const std::vector<std::string>& row = cells.back();
    if (row.size() < 2 || (widest && row.size() <= widest->cells) || broken || !is_row(row, decimal_comma)) continue;
    const std::size_t first_row = cells.size() - 1;
    std::size_t header = first_row;
    while (header > 0 && as_many(cells[header - 1], row) && !is_row(cells[header - 1], decimal_comma)) --header;
    if (header == first_row) continue;
    widest = Layout{.dialect = {.separator = separator, .header = header, .first_row = first_row}, .cells = row.size()};
  }
  return widest;
}

}  // namespace

bool is_missing(std::string_view cell) {
  if (cell.empty()) return true;
  // What programs write where there is no number: also a dash, Microsoft's C library, and Excel's errors, which begin
  // with # and end with ! or ? but for #N/A (#NV in German).
  constexpr std::array<std::string_view, 16> kWords = {"nan",     "+nan",   "-nan",    "na",       "n/a",  "null",
                                                       "none",    "nat",    "-",       "--",       "#n/a", "#nv",
                                                       "1.#qnan", "1.#ind", "-1.#ind", "-nan(ind)"};
  if (std::ranges::any_of(kWords, [&](std::string_view word) { return equal_ignoring_case(cell, word); })) return true;
  return cell.front() == '#' && cell.size() > 2 && (cell.back() == '!' || cell.back() == '?');
}

std::vector<std::string> cells_of(std::string_view line, char separator, bool& broken) {
  std::vector<std::string> out;
  CsvCells cells(line, separator);
  for (std::string_view cell; cells.next(cell);) out.emplace_back(cell);
  broken = cells.broken();
  return out;
}

char detect_separator(std::string_view line) {
  constexpr std::array<char, 3> kSeparators = {',', ';', '\t'};
  std::array<std::size_t, 3> counts{};
  bool in_quotes = false;
  for (const char c : line) {
    if (c == '"') in_quotes = !in_quotes;
    for (std::size_t i = 0; i < kSeparators.size(); ++i) counts.at(i) += !in_quotes && c == kSeparators.at(i) ? 1 : 0;
  }
  return kSeparators.at(static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin()));
}

CsvDialect dialect_of(const std::vector<std::string>& lines) {
  std::optional<Layout> best;
  for (const char separator : {',', ';', '\t'}) {
    const auto layout = layout_with(separator, lines);
    if (layout && (!best || layout->cells > best->cells)) best = layout;
  }
  if (best) return best->dialect;
  return {.separator = detect_separator(lines.front())};
}

}  // namespace steerid
