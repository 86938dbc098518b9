// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Writes CSV as the reader reads it: a header, one row at a time, the file whole or not at all.
//
// Numbers are written shortest such that reading gives the same double back, or with a fixed count of digits after
// the decimal point; never by the locale, so that the same values give the same bytes everywhere. A value that is not
// finite becomes an empty cell. Text that holds a comma, a quote, a # or a line break is quoted; line breaks
// become spaces, so that a row stays a line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "log/record.hpp"
#include "log/table_writer.hpp"
#include "log/whole_file.hpp"

namespace steerid {

class CsvWriter final : public TableWriter {
 public:
  /// Writes each of `comments` as a line after "# ", then the header. Throws BadInput as WholeFile does.
  CsvWriter(const std::filesystem::path& target, const std::vector<std::string>& columns,
            const std::vector<std::string>& comments = {});

  /// The next cell of the row: shortest round trip.
  CsvWriter& cell(double value) override;
  /// With `digits` after the decimal point.
  CsvWriter& cell(double value, int digits) override;
  CsvWriter& cell(std::string_view text) override;

  /// Ends the row. Throws std::logic_error when it has not one cell for each column.
  void end_row() override;

  /// Puts the file in its place.
  void commit() override { file_.commit(); }

 private:
  void separate();

  WholeFile file_;
  std::size_t columns_;
  std::size_t cells_ = 0;
  std::string row_;
};

/// The record's channels under the contract's columns, with shortest numbers: read_log gives the same bits back.
void write_record(const std::filesystem::path& target, const Record& record,
                  const std::vector<std::string>& comments = {});

}  // namespace steerid
