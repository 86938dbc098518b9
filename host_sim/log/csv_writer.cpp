// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/csv_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "log/log_format.hpp"

namespace steerid {
namespace {

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return line;
}

std::string quoted_where_needed(std::string_view text) {
  if (text.find_first_of(",;\t\"#\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : one_line(text)) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& target, const std::vector<std::string>& columns,
                     const std::vector<std::string>& comments)
    : file_(target), columns_(columns.size()) {
  for (const std::string& comment : comments) file_.write("# " + one_line(comment) + "\n");
  for (const std::string& column : columns) cell(column);
  end_row();
}

void CsvWriter::separate() {
  if (cells_++ > 0) row_ += ',';
}

CsvWriter& CsvWriter::cell(double value) {
  separate();
  if (!std::isfinite(value)) return *this;
  std::array<char, 32> text;  // the longest shortest double has 24 characters
  const auto [stop, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  row_.append(text.data(), stop);
  return *this;
}

CsvWriter& CsvWriter::cell(double value, int digits) {
  separate();
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(row_), "{:.{}f}", value, digits);
  return *this;
}

CsvWriter& CsvWriter::cell(std::string_view text) {
  separate();
  row_ += quoted_where_needed(text);
  return *this;
}

void CsvWriter::end_row() {
  if (cells_ != columns_) {
    throw std::logic_error(fmt::format("a CSV row of {} cells under {} columns", cells_, columns_));
  }
  row_ += '\n';
  file_.write(row_);
  row_.clear();
  cells_ = 0;
}

void write_record(const std::filesystem::path& target, const Record& record, const std::vector<std::string>& comments) {
  std::vector<std::string> columns;
  std::vector<const std::vector<double>*> values;
  for (const Channel channel : kAllChannels) {
    if (channel != Channel::kTime && !record.has(valid_bit(channel))) continue;
    columns.emplace_back(contract_column(channel));
    values.push_back(&values_of(record, channel));
  }
  CsvWriter csv(target, columns, comments);
  for (std::size_t i = 0; i < record.size(); ++i) {
    for (const std::vector<double>* column : values) csv.cell((*column)[i]);
    csv.end_row();
  }
  csv.commit();
}

}  // namespace steerid
