// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/csv_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <utility>

#include "log/bad_input.hpp"
#include "log/csv_dialect.hpp"
#include "log/csv_lines.hpp"
#include "log/log_format.hpp"
#include "log/progress.hpp"
#include "log/stamp_limits.hpp"
#include "log/text.hpp"
#include "log/time_text.hpp"
#include "log/units.hpp"

namespace steerid {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum class Cell : std::uint8_t { kNumber, kInfinite, kText };

/// What a cell holds that is no plain number and not missing. A number too small for a double is zero, one too large is
/// infinite.
Cell read_odd_cell(std::string_view text, bool decimal_comma, double& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  for (const std::string_view word : {"inf", "-inf", "infinity", "-infinity"}) {
    if (equal_ignoring_case(text, word)) return Cell::kInfinite;
  }
  if (is_number(text, decimal_comma, value)) return Cell::kNumber;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (stop != text.data() + text.size()) return Cell::kText;
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(text).c_str(), nullptr);
  return std::isfinite(value) ? Cell::kNumber : Cell::kInfinite;
}

class CsvSource final : public LogSource {
 public:
  explicit CsvSource(OpenedLog log) : log_(std::move(log)), lines_(*log_.in, log_.name) {
    read_first_lines();
    dialect_ = dialect_of(first_lines_);
    take_names();
    take_units();
  }

  [[nodiscard]] const std::vector<LogColumn>& columns() const override { return columns_; }
  [[nodiscard]] bool time_is_a_column() const override { return true; }
  [[nodiscard]] std::size_t header_line() const override { return first_numbers_[dialect_.header]; }

  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

  [[nodiscard]] std::vector<StampedColumns> read(const Wanted& wanted) override {
    start(wanted);
    for (std::size_t i = dialect_.first_row; i < first_lines_.size(); ++i) {
      take_row(first_lines_[i], first_numbers_[i], lines_.end_is_open() && i + 1 == first_lines_.size());
    }
    Progress progress("reading " + log_.name, log_.bytes_in_all >= kLongFileBytes ? log_.bytes_in_all : 0);
    for (std::string_view line; next_line(line);) {
      take_row(line, lines_.number(), lines_.end_is_open());
      progress.at(lines_.bytes_read());
    }
    std::vector<StampedColumns> all;
    all.push_back(std::move(rows_));
    return all;
  }

 private:
  static constexpr std::uint64_t kLongFileBytes = std::uint64_t{32} << 20;  // a quarter of a second
  static constexpr std::uint64_t kMostBytesToReserveFor = std::uint64_t{1} << 28;
  static constexpr std::size_t kRowsToJudgeBy = 1000;
  static constexpr std::size_t kUnwanted = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t kTime = kUnwanted - 1;

  /// The next line that is neither blank nor a comment.
  bool next_line(std::string_view& line) {
    while (lines_.next(line)) {
      const std::string_view text = trimmed(line);
      if (!text.empty() && text.front() != '#') return true;
    }
    return false;
  }

  void read_first_lines() {
    std::string_view line;
    while (first_lines_.size() < kLinesToJudgeBy && next_line(line)) {
      first_lines_.emplace_back(line);
      first_numbers_.push_back(lines_.number());
    }
    if (first_lines_.empty()) {
      throw bad_input({.file = log_.name,
                       .expected = "a header line and rows",
                       .found = "an empty file",
                       .advice = "check that the log was written"});
    }
  }

  void take_names() {
    const std::string& text = first_lines_[dialect_.header];
    bool broken = false;
    bool all_numbers = true;
    for (std::string& name : cells_of(text, dialect_.separator, broken)) {
      double value = 0;
      all_numbers = all_numbers && is_number(name, dialect_.decimal_comma(), value);
      columns_.push_back({.name = std::move(name)});
    }
    if (broken) {
      throw bad_input({.file = log_.name,
                       .line = header_line(),
                       .expected = "names of columns with every quote closed",
                       .found = in_quotes(text),
                       .advice = "close the quote"});
    }
    if (all_numbers) {
      throw bad_input({.file = log_.name,
                       .line = header_line(),
                       .expected = "a header with the columns' names",
                       .found = in_quotes(text),
                       .advice = "put a line such as time_s,torque_bar_nm,angle_rad above the rows"});
    }
  }

  void take_units() {
    for (std::size_t i = dialect_.header + 1; i < std::min(dialect_.first_row, first_lines_.size()); ++i) {
      bool broken = false;
      const std::vector<std::string> units = cells_of(first_lines_[i], dialect_.separator, broken);
      for (std::size_t column = 0; column < std::min(units.size(), columns_.size()); ++column) {
        std::string& unit = columns_[column].unit;
        if (unit.empty() || (!is_unit(unit) && is_unit(units[column]))) unit = units[column];
      }
    }
    if (dialect_.first_row < first_lines_.size()) take_dates(first_lines_[dialect_.first_row]);
  }

  /// A date states its unit itself.
  void take_dates(const std::string& row) {
    bool broken = false;
    const std::vector<std::string> cells = cells_of(row, dialect_.separator, broken);
    for (std::size_t column = 0; column < std::min(cells.size(), columns_.size()); ++column) {
      const bool date = cells[column].find(':') != std::string::npos && seconds_of(cells[column]);
      if (date && columns_[column].unit.empty()) columns_[column].unit.push_back('s');
    }
  }

  void start(const Wanted& wanted) {
    wanted_ = wanted;
    use_.assign(columns_.size(), kUnwanted);
    if (wanted_.time) use_[wanted_.time->column] = kTime;
    for (std::size_t i = 0; i < wanted_.columns.size(); ++i) {
      use_[wanted_.columns[i].column] = i;
      rows_.wanted.push_back(i);
    }
    rows_.values.resize(wanted_.columns.size());
    row_.resize(wanted_.columns.size());
  }

  /// A line that its writer was stopped in, and left open, is no row.
  void take_row(std::string_view line, std::size_t number, bool end_is_open) {
    number_ = number;
    double time_s = kMissing;
    bool whole = false;
    try {
      whole = parse_row(line, time_s);
    } catch (const BadInput&) {
      if (is_of_head(line)) {
        notes_.push_back(fmt::format("line {} of {} repeats the header: left out", number, log_.name));
        return;
      }
      if (!end_is_open || rows_.time_s.empty()) throw;
      notes_.push_back(fmt::format("line {} of {}, the last, is cut off: left out", number, log_.name));
      return;
    }
    if (!whole && rows_.first_incomplete_line == 0) rows_.first_incomplete_line = number_;
    if (std::isnan(time_s)) {
      ++rows_.rows_without_stamp;
      return;
    }
    if (std::abs(time_s) > kLatestTimeS) complain_far_time(time_s);
    if (!rows_.time_s.empty() && time_s < rows_.time_s.back()) complain_time(time_s);
    rows_.time_s.push_back(time_s);
    for (std::size_t i = 0; i < row_.size(); ++i) rows_.values[i].push_back(row_[i]);
    last_number_ = number_;
    row_bytes_ += line.size() + 1;
    if (rows_.time_s.size() == kRowsToJudgeBy) reserve();
  }

  /// Whether it is the header again, or the line of units below it: where one log was appended to another.
  [[nodiscard]] bool is_of_head(std::string_view line) const {
    const auto head = std::span(first_lines_).first(std::min(dialect_.first_row, first_lines_.size()));
    return std::ranges::find(head.subspan(dialect_.header), line) != head.end();
  }

  /// False when a value that is wanted is missing.
  bool parse_row(std::string_view line, double& time_s) {
    CsvCells cells(line, dialect_.separator);
    bool whole = true;
    std::size_t count = 0;
    std::string_view text;
    for (; count < columns_.size(); ++count) {
      const std::size_t use = use_[count];
      if (use == kUnwanted) {
        if (!cells.next(text)) break;
        continue;
      }
      double value = kMissing;
      if (!cells.next_number(value)) {
        if (!cells.next(text)) break;
        value = read_cell(count, text, use == kTime);
      }
      const ToSi& to_si = use == kTime ? wanted_.time->to_si : wanted_.columns[use].to_si;
      const double si = std::isnan(value) || (use == kTime && dated_) ? value : finite_si(count, value, to_si);
      (use == kTime ? time_s : row_[use]) = si;
      whole = whole && !std::isnan(si);
    }
    bool more = false;
    while (cells.next(text)) {
      more = more || !text.empty() || count > columns_.size();
      ++count;
    }
    const bool ends_in_separator = count == columns_.size() + 1 && !more;
    if (cells.broken() || (count != columns_.size() && !ends_in_separator)) complain_cells(count, cells.broken(), line);
    return whole;
  }

  /// NaN when the cell is missing; throws when it is neither missing nor a finite number.
  double read_cell(std::size_t column, std::string_view text, bool is_time) {
    if (is_missing(text)) return kMissing;
    double value = 0;
    const Cell kind = read_odd_cell(text, dialect_.decimal_comma(), value);
    if (kind == Cell::kNumber) return value;
    if (is_time) {
      if (const auto stamp_s = seconds_of(text)) {
        dated_ = true;
        return *stamp_s;
      }
    }
    if (wanted_.text_is_missing) return kMissing;
    complain_cell(column, kind, text);
  }

  [[noreturn]] void complain_cell(std::size_t column, Cell kind, std::string_view text) const {
    const bool comma = kind == Cell::kText && text.find(',') != std::string_view::npos;
    throw bad_input({.file = log_.name,
                     .line = number_,
                     .column = columns_[column].name,
                     .expected = kind == Cell::kInfinite ? "a finite number" : "a number",
                     .found = in_quotes(text),
                     .advice = comma ? "write numbers without a mark for the thousands, with one decimal point or comma"
                                     : "leave the cell empty where nothing was measured"});
  }

  /// A scale may carry a number out of range.
  [[nodiscard]] double finite_si(std::size_t column, double number, const ToSi& to_si) const {
    const double si = to_si(number);
    if (std::isfinite(si)) return si;
    if (wanted_.text_is_missing) return kMissing;
    complain_cell(column, Cell::kInfinite, fmt::format("{}", number));
  }

  /// The first rows tell about how many there will be, so that the columns need not grow by copying. Memory that is
  /// reserved and never written costs nothing.
  void reserve() {
    // A file may be mostly holes, and its length then says nothing.
    const std::uint64_t bytes = std::min(log_.bytes_in_all, kMostBytesToReserveFor);
    const std::uint64_t rows = bytes * kRowsToJudgeBy / row_bytes_;
    const auto with_margin = static_cast<std::size_t>(rows + rows / 16);
    rows_.time_s.reserve(with_margin);
    for (std::vector<double>& column : rows_.values) column.reserve(with_margin);
  }

  [[noreturn]] void complain_cells(std::size_t count, bool broken, std::string_view line) const {
    throw bad_input({.file = log_.name,
                     .line = number_,
                     .expected = broken ? "every quote closed" : fmt::format("{} cells", columns_.size()),
                     .found = broken ? in_quotes(line) : fmt::format("{}", count),
                     .advice = "complete the row or delete it"});
  }

  [[nodiscard]] const std::string& time_column() const { return columns_[wanted_.time->column].name; }

  [[noreturn]] void complain_far_time(double time_s) const {
    const double apart_s = rows_.time_s.empty() ? 0 : time_s - rows_.time_s.back();
    throw bad_input({.file = log_.name,
                     .line = number_,
                     .column = time_column(),
                     .expected = fmt::format("a time within {:g} s of zero", kLatestTimeS),
                     .found = fmt::format("{:g} s", time_s),
                     .advice = fmt::format("state the unit of time with --columns {}",
                                           choice_text(Channel::kTime, {.name = time_column(),
                                                                        .unit = likely_time_unit(time_s, apart_s)}))});
  }

  [[noreturn]] void complain_time(double time_s) const {
    throw bad_input({.file = log_.name,
                     .line = number_,
                     .column = time_column(),
                     .expected = fmt::format("a time after the {} s of line {}", rows_.time_s.back(), last_number_),
                     .found = fmt::format("{} s", time_s),
                     .advice = "split the file where its clock goes back"});
  }

  OpenedLog log_;
  CsvLines lines_;
  std::vector<std::string> first_lines_{};
  std::vector<std::size_t> first_numbers_{};
  CsvDialect dialect_{};
  std::vector<LogColumn> columns_{};
  Wanted wanted_{};
  std::vector<std::size_t> use_{};  ///< of each column: its index in Wanted::columns, kTime or kUnwanted
  StampedColumns rows_{};
  std::vector<std::string> notes_{};
  std::vector<double> row_{};
  bool dated_ = false;  ///< stamps are dates: in seconds whatever the unit
  std::uint64_t row_bytes_ = 0;
  std::size_t number_ = 0;
  std::size_t last_number_ = 0;
};

}  // namespace

std::unique_ptr<LogSource> open_csv(OpenedLog log) { return std::make_unique<CsvSource>(std::move(log)); }

}  // namespace steerid
