// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The seam between a log's format and what is made of the log: a format gives columns and, of those that are wanted,
// values with stamps. It knows nothing of channels, units and equations.
//
// A new format is one class like this one in a file of its own, and a line in log_sources.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace steerid {

/// A column, a bus's signal or a message's field.
struct LogColumn {
  std::string name;    ///< as the file names it, in UTF-8
  std::string unit{};  ///< as the file states it beside the name; empty when it does not
};

/// What makes SI units of a column's numbers: (number * scale + offset) / per_si.
struct ToSi {
  double scale = 1.0;
  double offset = 0.0;
  double per_si = 1.0;  ///< negative when the channel is turned round

  [[nodiscard]] double operator()(double number) const { return (number * scale + offset) / per_si; }
};

struct WantedColumn {
  std::size_t column = 0;  ///< index into LogSource::columns()
  ToSi to_si{};
};

struct Wanted {
  std::optional<WantedColumn> time{};  ///< needed when LogSource::time_is_a_column()
  std::vector<WantedColumn> columns{};
  bool text_is_missing = false;  ///< a cell that is no number is missing; else it is a BadInput
};

/// Columns that share their stamps: rows.
struct StampedColumns {
  std::vector<double> time_s{};               ///< never decreasing
  std::vector<std::size_t> wanted{};          ///< for each column its index in Wanted::columns
  std::vector<std::vector<double>> values{};  ///< for each column a value a stamp; NaN where there is none
  std::size_t rows_without_stamp = 0;         ///< left out already
  std::size_t first_incomplete_line = 0;      ///< of the text file; 0: no row lacks a value, or no lines
};

class LogSource {
 public:
  LogSource() = default;
  LogSource(const LogSource&) = delete;
  LogSource& operator=(const LogSource&) = delete;
  virtual ~LogSource() = default;

  [[nodiscard]] virtual const std::vector<LogColumn>& columns() const = 0;

  /// False where every value carries its stamp, as on a bus: then no column need be named for the time.
  [[nodiscard]] virtual bool time_is_a_column() const = 0;

  /// Where the columns are named, for sentences; 0 when the file has no lines.
  [[nodiscard]] virtual std::size_t header_line() const { return 0; }

  /// Reads the rest of the file, once. Throws BadInput.
  [[nodiscard]] virtual std::vector<StampedColumns> read(const Wanted& wanted) = 0;

  /// Whole sentences on what was taken for granted; complete after read().
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

/// A file that is open, and what a format needs to read it.
struct OpenedLog {
  std::unique_ptr<std::istream> in;
  std::string name;                          ///< stands for the file in sentences
  std::uint64_t bytes_in_all = 0;            ///< 0 when the stream does not tell
  std::vector<std::filesystem::path> dbc{};  ///< --dbc
};

/// By the first bytes. Throws BadInput for what is no log, with the command that makes one of it where there is one.
[[nodiscard]] std::unique_ptr<LogSource> open_log(OpenedLog log);
[[nodiscard]] std::unique_ptr<LogSource> open_log(const std::filesystem::path& path,
                                                  const std::vector<std::filesystem::path>& dbc);

}  // namespace steerid
