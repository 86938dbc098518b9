// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A table about many records: the same rows as CSV, as JSON lines and on the fleet's page.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace steerid::fleet {

/// A record, by its name; on the page a link to its own.
struct RecordName {
  std::string name;
};

/// A number of records; on the page a link to the table that lists them, by that table's key.
struct CountOf {
  double number;
  std::string list;
};

/// Nothing, words, a number (NaN is nothing), a record or a count.
using FleetCell = std::variant<std::monostate, std::string, double, RecordName, CountOf>;

/// Labels of the two columns that hold the ends of the interval of the one before them.
inline constexpr const char* kLow = "from";
inline constexpr const char* kHigh = "to";

struct FleetColumn {
  std::string key;        ///< in the header and in JSON, with its unit: "share_low", "slope_per_year"
  std::string label;      ///< on the page
  bool numeric = true;    ///< words and records are not
  std::string unit = {};  ///< on the page
};

struct FleetTable {
  std::string key;  ///< of the file: "changes"
  std::string title;
  std::string caption;
  std::vector<FleetColumn> columns;
  std::vector<std::vector<FleetCell>> rows = {};
};

/// Writes FOLDER/KEY.csv, and FOLDER/KEY.jsonl with an object a row; each whole or not at all. Throws BadInput.
void write_table(const std::filesystem::path& folder, const FleetTable& table);

}  // namespace steerid::fleet
