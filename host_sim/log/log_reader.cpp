// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <optional>

#include "log/bad_input.hpp"
#include "log/csv_lines.hpp"
#include "log/input_file.hpp"
#include "log/log_header.hpp"
#include "log/progress.hpp"
#include "log/text.hpp"

namespace steerid {
namespace {

enum class Cell { kNumber, kMissing, kInfinite, kText };

/// What a cell holds that is no plain number. A number too small for a double is zero, one too large is infinite.
Cell read_odd_cell(std::string_view text, double& value) {
  if (text.empty()) return Cell::kMissing;
  for (const std::string_view word : {"nan", "+nan", "-nan", "na", "n/a", "null", "none"}) {
    if (equal_ignoring_case(text, word)) return Cell::kMissing;
  }
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  for (const std::string_view word : {"inf", "-inf", "infinity", "-infinity"}) {
    if (equal_ignoring_case(text, word)) return Cell::kInfinite;
  }
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (stop != text.data() + text.size()) return Cell::kText;
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(text).c_str(), nullptr);
  return std::isfinite(value) ? Cell::kNumber : Cell::kInfinite;
}

class LogReader {
 public:
  LogReader(std::istream& in, const std::string& name, const LogFormat& format, std::uint64_t bytes_in_all)
      : name_(name), format_(format), bytes_in_all_(bytes_in_all), lines_(in, name) {}

  Record read(RecordQuality* noticed) {
    std::string_view line;
    if (!next_line(line)) {
      throw bad_input({.file = name_,
                       .expected = "a header line and rows",
                       .found = "an empty file",
                       .advice = "check that the log was written"});
    }
    header_ = understand_header(line, format_, name_, lines_.number());
    Progress progress("reading " + name_, bytes_in_all_ >= kLongFileBytes ? bytes_in_all_ : 0);
    while (next_line(line)) {
      take_row(line);
      progress.at(lines_.bytes_read());
    }
    fill_absent();
    RecordQuality quality = checked_quality();
    if (noticed != nullptr) *noticed = std::move(quality);
    return std::move(record_);
  }

 private:
  static constexpr std::uint64_t kLongFileBytes = std::uint64_t{32} << 20;  // a quarter of a second
  static constexpr std::uint64_t kMostBytesToReserveFor = std::uint64_t{1} << 28;
  static constexpr std::size_t kRowsToJudgeBy = 1000;

  /// The next line that is neither blank nor a comment.
  bool next_line(std::string_view& line) {
    while (lines_.next(line)) {
      const std::string_view text = trimmed(line);
      if (!text.empty() && text.front() != '#') return true;
    }
    return false;
  }

  std::vector<double>& column(std::size_t channel) { return values_of(record_, static_cast<Channel>(channel)); }

  void take_row(std::string_view line) {
    std::array<double, kChannels> values{};
    if (!parse_row(line, values)) {
      if (dropped_rows_++ == 0) first_dropped_line_ = lines_.number();
      return;
    }
    const double time_s = values[0];
    if (std::abs(time_s) > kLatestTimeS) complain_far_time(time_s);
    if (!record_.time_s.empty() && !(time_s > record_.time_s.back())) complain_time(time_s);
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      if (header_.present[channel]) column(channel).push_back(values[channel]);
    }
    last_line_ = lines_.number();
    row_bytes_ += line.size() + 1;
    if (record_.size() == kRowsToJudgeBy) reserve();
  }

  /// False when a value that is needed is missing.
  bool parse_row(std::string_view line, std::array<double, kChannels>& values) {
    CsvCells cells(line, header_.separator);
    bool whole = true;
    std::size_t count = 0;
    std::string_view text;
    for (; count < header_.names.size(); ++count) {
      const std::size_t channel = header_.channel_of[count];
      if (channel == LogHeader::kUnused) {
        if (!cells.next(text)) break;
        continue;
      }
      double value = 0.0;
      if (!cells.next_number(value)) {
        value = 0.0;
        if (!cells.next(text)) break;
        whole = read_cell(count, text, value) && whole;
      }
      values[channel] = value / header_.per_si[channel];
    }
    while (cells.next(text)) ++count;
    if (cells.broken() || count != header_.names.size()) complain_cells(count, cells.broken(), line);
    return whole;
  }

  /// False when the cell is missing; throws when it is neither missing nor a finite number.
  bool read_cell(std::size_t cell, std::string_view text, double& value) {
    const Cell kind = read_odd_cell(text, value);
    if (kind == Cell::kNumber) return true;
    if (kind == Cell::kMissing) return false;
    const bool comma = kind == Cell::kText && text.find(',') != std::string_view::npos;
    throw bad_input(
        {.file = name_,
         .line = lines_.number(),
         .column = header_.names[cell],
         .expected = kind == Cell::kInfinite ? "a finite number" : "a number",
         .found = in_quotes(text),
         .advice = comma ? "write numbers with a decimal point" : "leave the cell empty where nothing was measured"});
  }

  /// The first rows tell about how many there will be, so that the columns need not grow by copying. Memory that is
  /// reserved and never written costs nothing.
  void reserve() {
    // A file may be mostly holes, and its length then says nothing.
    const std::uint64_t bytes = std::min(bytes_in_all_, kMostBytesToReserveFor);
    const std::uint64_t rows = bytes * kRowsToJudgeBy / row_bytes_;
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      if (header_.present[channel]) column(channel).reserve(static_cast<std::size_t>(rows + rows / 16));
    }
  }

  void fill_absent() {
    record_.channels = header_.channels();
    for (const Channel channel : {Channel::kTorqueDriver, Channel::kTorqueMotor}) {
      if (!header_.present[static_cast<std::size_t>(channel)]) {
        values_of(record_, channel).assign(record_.time_s.size(), 0.0);
      }
    }
  }

  RecordQuality checked_quality() {
    if (record_.size() < kFewestRows) {
      throw bad_input({.file = name_,
                       .expected = fmt::format("at least {} rows with values", kFewestRows),
                       .found = fmt::format("{}", record_.size()),
                       .advice = "record a longer drive"});
    }
    RecordQuality quality = quality_of(record_);
    // Stamps are rounded by whoever wrote them: 1 % keeps a true 50 Hz in.
    if (quality.median_period_s > 1.01 / kLowestRateHz) {
      throw bad_input({.file = name_,
                       .column = std::string(header_.column(Channel::kTime)),
                       .expected = fmt::format("{} rows a second or more", kLowestRateHz),
                       .found = fmt::format("{:.4g} (median)", 1.0 / quality.median_period_s),
                       .advice = "record faster, or state the unit of time with --columns time=COLUMN:ms"});
    }
    quality.dropped_rows = dropped_rows_;
    quality.notes = std::move(header_.notes);
    if (dropped_rows_ > 0) {
      quality.notes.push_back(fmt::format("{} rows with an empty or NaN cell left out, the first in line {}",
                                          dropped_rows_, first_dropped_line_));
    }
    return quality;
  }

  [[noreturn]] void complain_cells(std::size_t count, bool broken, std::string_view line) const {
    throw bad_input({.file = name_,
                     .line = lines_.number(),
                     .expected = broken ? "every quote closed" : fmt::format("{} cells", header_.names.size()),
                     .found = broken ? in_quotes(line) : fmt::format("{}", count),
                     .advice = "complete the row or delete it"});
  }

  [[noreturn]] void complain_far_time(double time_s) const {
    throw bad_input({.file = name_,
                     .line = lines_.number(),
                     .column = std::string(header_.column(Channel::kTime)),
                     .expected = fmt::format("a time within {:g} s of zero", kLatestTimeS),
                     .found = fmt::format("{:g} s", time_s),
                     .advice = "state the unit of time with --columns time=COLUMN:us"});
  }

  [[noreturn]] void complain_time(double time_s) const {
    const double before_s = record_.time_s.back();
    throw bad_input({.file = name_,
                     .line = lines_.number(),
                     .column = std::string(header_.column(Channel::kTime)),
                     .expected = fmt::format("a time after the {} s of line {}", before_s, last_line_),
                     .found = fmt::format("{} s", time_s),
                     .advice = time_s == before_s ? "delete the repeated row or give the stamps more digits"
                                                  : "split the file where its clock goes back"});
  }

  const std::string& name_;
  const LogFormat& format_;
  std::uint64_t bytes_in_all_;  // 0 when the stream does not tell
  CsvLines lines_;
  LogHeader header_;
  Record record_;
  std::uint64_t row_bytes_ = 0;
  std::size_t dropped_rows_ = 0;
  std::size_t first_dropped_line_ = 0;
  std::size_t last_line_ = 0;
};

}  // namespace

Record read_log(const std::filesystem::path& path, const LogFormat& format, RecordQuality* noticed) {
  if (path == "-") return LogReader(std::cin, "standard input", format, 0).read(noticed);
  check_input_file(path, "a CSV file");
  std::error_code ignored;
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw bad_input({.file = path.string(),
                     .expected = "a readable file",
                     .found = fmt::format("\"{}\"", std::strerror(errno)),
                     .advice = "check its name and permissions"});
  }
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  return LogReader(in, path.string(), format, ignored ? 0 : size).read(noticed);
}

Record read_log(std::istream& in, const std::string& name, const LogFormat& format, RecordQuality* noticed) {
  return LogReader(in, name, format, 0).read(noticed);
}

}  // namespace steerid
