// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a study found, described once: figures that were asked for beside what was measured, tables, charts. Told as CSV
// and JSON for programs, as a page for readers and as text for a terminal.
//
//   NAME.csv   table,case,figure,unit,value      one row a figure; `asked` is a table like the others
//   NAME.json  {"schema":"steerid.study/1", "study":NAME, "asked":[..], "tables":{TABLE:[{..},..]},
//               "options":{..}, "program":{..}}
//   NAME.html  the answer, the charts, the tables
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/parts.hpp"

namespace steerid {

/// A figure that the project set out to reach.
struct AskedFigure {
  enum class Limit : std::uint8_t { kAtMost, kAtLeast };
  /// Open: what was measured does not decide it.
  enum class Standing : std::uint8_t { kMet, kMissed, kOpen };
  /// Of fewer drives a median's 95 % interval is all that was seen; of ten it is from the second to the ninth (order
  /// statistics, binomial).
  static constexpr std::size_t kFewestDrives = 10;

  std::string what;  ///< "worst drift of J over a curve of 120 s"
  std::string unit;
  double measured = 0;
  double asked = 0;
  Limit limit = Limit::kAtMost;
  std::size_t drives = kFewestDrives;  ///< of the case with the fewest
  std::optional<report::Ends> ci95{};  ///< of what was measured, where it is known

  /// A figure that is no number is missed.
  [[nodiscard]] bool met() const { return limit == Limit::kAtMost ? measured <= asked : measured >= asked; }
  /// Open with fewer than kFewestDrives, and where the interval holds what is asked; a figure that is no number is
  /// missed.
  [[nodiscard]] Standing standing() const {
    if (drives < kFewestDrives || (ci95 && ci95->low <= asked && asked < ci95->high)) return Standing::kOpen;
    return met() ? Standing::kMet : Standing::kMissed;
  }
};

struct FoundColumn {
  std::string key;  ///< in the files: "valid_percent"
  report::Column shown;
};

/// Of numbers, shown with three digits.
[[nodiscard]] inline FoundColumn number_column(const char* key, const char* label, const char* unit = "") {
  return {key, {.label = label, .unit = unit, .digits = 3}};
}

/// Of words: what names a row's case.
[[nodiscard]] inline FoundColumn word_column(const char* key, const char* label) {
  return {key, {.label = label, .numeric = false}};
}

/// The leading cells that are words name the row's case; the others are numbers.
struct FoundTable {
  std::string name;  ///< in the files: "following"
  std::string title;
  std::string caption;
  std::vector<FoundColumn> columns;
  std::vector<std::vector<report::Cell>> rows;
};

struct Findings {
  std::string study;    ///< its name
  std::string title;    ///< what it asks
  std::string how;      ///< the conditions, whole sentences
  std::string command;  ///< that repeats it
  std::vector<AskedFigure> asked;
  std::vector<report::Bars> charts;
  std::vector<report::LineChart> lines{};
  std::vector<FoundTable> tables;

  /// One cell: the table's name, the row's leading words joined by ", ", the column's key. Throws std::out_of_range.
  [[nodiscard]] double figure(std::string_view table, std::string_view row, std::string_view key) const;
};

/// Told, on the calling thread, how much of how much is done.
using StudyProgress = std::function<void(std::size_t done, std::size_t of)>;

[[nodiscard]] std::string findings_text(const Findings& findings);
[[nodiscard]] std::string findings_csv(const Findings& findings);
[[nodiscard]] std::string findings_json(const Findings& findings,
                                        const nlohmann::ordered_json& made_by = nlohmann::ordered_json::object());

/// Makes `folder` when it is missing. Throws BadInput when it cannot be written.
void write_findings(const std::filesystem::path& folder, const Findings& findings,
                    const nlohmann::ordered_json& made_by);

}  // namespace steerid
