// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where rows of named columns are written to: CSV, or MCAP where the file's name ends in .mcap. A new format is a class
// like CsvWriter in a file of its own, and a line in table_writer.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace steerid {

/// How MCAP's messages are written.
enum class McapMessages : std::uint8_t { kCdr, kJson };

struct Table {
  std::string what;  ///< "record", "estimate": a message's topic is /steerid/WHAT
  std::vector<std::string> columns;
  std::vector<std::string> comments{};
  McapMessages messages = McapMessages::kCdr;
};

class TableWriter {
 public:
  TableWriter() = default;
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;
  virtual ~TableWriter() = default;

  /// The next cell of the row: a number as exact as it is. One that is not finite is missing.
  virtual TableWriter& cell(double value) = 0;
  /// With `digits` after the decimal point, rounded to them.
  virtual TableWriter& cell(double value, int digits) = 0;
  virtual TableWriter& cell(std::string_view text) = 0;

  /// Ends the row. Throws std::logic_error when it has not one cell for each column.
  virtual void end_row() = 0;

  /// Puts the file in its place: it appears whole or not at all.
  virtual void commit() = 0;
};

[[nodiscard]] bool is_mcap_name(const std::filesystem::path& target);

/// Throws BadInput where the file cannot be written.
[[nodiscard]] std::unique_ptr<TableWriter> open_table(const std::filesystem::path& target, const Table& table);

}  // namespace steerid
