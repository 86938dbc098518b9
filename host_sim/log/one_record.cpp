// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/one_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "log/bad_input.hpp"
#include "log/quantile.hpp"
#include "log/record_quality.hpp"
#include "log/shared_stamps.hpp"

namespace steerid {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool complete(const StampedColumns& group, std::size_t row) {
  return std::ranges::none_of(group.values, [&](const std::vector<double>& column) { return std::isnan(column[row]); });
}

std::size_t count_values(const std::vector<double>& column) {
  return static_cast<std::size_t>(std::ranges::count_if(column, [](double value) { return !std::isnan(value); }));
}

void keep_row(StampedColumns& group, std::size_t from, std::size_t to) {
  group.time_s[to] = group.time_s[from];
  for (std::vector<double>& column : group.values) column[to] = column[from];
}

void cut(StampedColumns& group, std::size_t rows) {
  group.time_s.resize(rows);
  for (std::vector<double>& column : group.values) column.resize(rows);
}

/// Leaves the incomplete rows out; how many.
std::size_t keep_complete_rows(StampedColumns& group) {
  std::size_t kept = 0;
  const std::size_t rows = group.time_s.size();
  for (std::size_t row = 0; row < rows; ++row) {
    if (!complete(group, row)) continue;
    if (kept != row) keep_row(group, row, kept);
    ++kept;
  }
  cut(group, kept);
  return rows - kept;
}

/// The group whole, or each of its columns by itself where they were merged from several clocks.
std::vector<StampedColumns> parted(StampedColumns group, OneClock& out) {
  std::size_t whole_rows = 0;
  for (std::size_t row = 0; row < group.time_s.size(); ++row) whole_rows += complete(group, row) ? 1 : 0;
  std::size_t most = 0;
  for (const std::vector<double>& column : group.values) most = std::max(most, count_values(column));
  std::vector<StampedColumns> parts;
  if (2 * whole_rows >= most || group.values.size() < 2) {
    const std::size_t left_out = keep_complete_rows(group) + group.rows_without_stamp;
    if (left_out > 0 && out.first_incomplete_line == 0) out.first_incomplete_line = group.first_incomplete_line;
    out.left_out += left_out;
    parts.push_back(std::move(group));
    return parts;
  }
  out.notes.emplace_back(
      "most rows lack a value: the columns were merged from several clocks, and each is taken by its own stamps");
  out.left_out += group.rows_without_stamp;
  for (std::size_t i = 0; i < group.values.size(); ++i) {
    StampedColumns one{.time_s = group.time_s, .wanted = {group.wanted[i]}};
    one.values.push_back(std::move(group.values[i]));
    keep_complete_rows(one);
    parts.push_back(std::move(one));
  }
  return parts;
}

bool equal_rows(const StampedColumns& group, std::size_t a, std::size_t b) {
  return std::ranges::all_of(group.values, [&](const std::vector<double>& column) { return column[a] == column[b]; });
}

struct Repeats {
  std::size_t written_twice = 0;
  SharedStamps shared;
};

/// Makes the stamps increase.
Repeats mend_repeats(StampedColumns& group, const std::string& name) {
  Repeats repeats;
  std::size_t kept = 0;
  for (std::size_t row = 0; row < group.time_s.size(); ++row) {
    if (kept > 0 && group.time_s[row] == group.time_s[kept - 1] && equal_rows(group, row, kept - 1)) {
      ++repeats.written_twice;
      continue;
    }
    if (kept != row) keep_row(group, row, kept);
    ++kept;
  }
  cut(group, kept);
  repeats.shared = spread_shared_stamps(group.time_s);
  constexpr std::size_t kMany = 2;  // a row and its correction say nothing of the stamps
  if (repeats.shared.rows + 1 == kept && kept > kMany) {
    throw bad_input({.file = name,
                     .expected = "stamps that increase",
                     .found = fmt::format("{} rows of the stamp {:.10g} s", kept, group.time_s.front()),
                     .advice = "write the time with more digits, or from the drive's beginning: seconds since 1970 in "
                               "single precision come in steps of 128 s"});
  }
  // Where stamps lie closer than a double tells, the rows behind the first have no place.
  std::size_t increasing = 0;
  for (std::size_t row = 0; row < kept; ++row) {
    if (increasing > 0 && !(group.time_s[row] > group.time_s[increasing - 1])) continue;
    if (increasing != row) keep_row(group, row, increasing);
    ++increasing;
  }
  cut(group, increasing);
  return repeats;
}

double median_period_s(const StampedColumns& group) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < group.time_s.size(); ++i) steps.push_back(group.time_s[i] - group.time_s[i - 1]);
  if (steps.empty()) return std::numeric_limits<double>::infinity();
  return median(std::move(steps));
}

/// A clock's gap-free stretches, walked along with the common clock.
class Cubic {
 public:
  explicit Cubic(const StampedColumns& group)
      : time_s_(group.time_s), longest_s_(longest_interval_s(median_period_s(group))) {
    find_stretch(0);
  }

  /// The four samples around `at_s`, never across a gap, and their weights; false where there are not four, or none on
  /// one side. `at_s` never goes back.
  bool at(double at_s) {
    while (at_s > time_s_[end_ - 1]) {
      if (end_ == time_s_.size()) return false;
      find_stretch(end_);
    }
    if (at_s < time_s_[begin_] || end_ - begin_ < kPoints) return false;
    next_ = std::max(next_, begin_);
    while (next_ + 1 < end_ && time_s_[next_ + 1] <= at_s) ++next_;
    first_ = std::clamp<std::size_t>(next_ == 0 ? 0 : next_ - 1, begin_, end_ - kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      weights_.at(i) = 1;
      for (std::size_t j = 0; j < kPoints; ++j) {
        if (i == j) continue;
        weights_.at(i) *= (at_s - time_s_[first_ + j]) / (time_s_[first_ + i] - time_s_[first_ + j]);
      }
    }
    return true;
  }

  [[nodiscard]] double of(const std::vector<double>& values) const {
    double sum = 0;
    for (std::size_t i = 0; i < kPoints; ++i) sum += weights_.at(i) * values[first_ + i];
    return sum;
  }

 private:
  static constexpr std::size_t kPoints = 4;

  void find_stretch(std::size_t begin) {
    begin_ = begin;
    end_ = begin + 1;
    while (end_ < time_s_.size() && time_s_[end_] - time_s_[end_ - 1] <= longest_s_) ++end_;
  }

  const std::vector<double>& time_s_;
  double longest_s_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t next_ = 0;
  std::size_t first_ = 0;
  std::array<double, kPoints> weights_{};
};

/// The other clock's columns at the stamps of `base`; NaN where it says nothing.
void join(StampedColumns& base, const StampedColumns& other) {
  const std::size_t rows = base.time_s.size();
  const std::size_t before = base.values.size();
  for (const std::size_t wanted : other.wanted) {
    base.wanted.push_back(wanted);
    base.values.emplace_back(rows, kNone);
  }
  if (other.time_s.empty()) return;
  Cubic cubic(other);
  for (std::size_t row = 0; row < rows; ++row) {
    if (!cubic.at(base.time_s[row])) continue;
    for (std::size_t i = 0; i < other.values.size(); ++i) {
      const double value = cubic.of(other.values[i]);
      base.values[before + i][row] = std::isfinite(value) ? value : kNone;
    }
  }
}

void note_repeats(const Repeats& repeats, OneClock& out) {
  if (repeats.written_twice > 0) {
    out.notes.push_back(fmt::format("{} rows that repeat the one before left out", repeats.written_twice));
  }
  if (repeats.shared.rows > 0) {
    out.notes.push_back(
        fmt::format("{} rows share the stamp of the one before: their stamps have too few digits, and they are {}",
                    repeats.shared.rows,
                    repeats.shared.without_clock == 0 ? "put where a steady clock has them"
                                                      : "spread evenly up to the next stamp"));
  }
}

std::string span_of(const StampedColumns& group) {
  if (group.time_s.empty()) return "no values";
  return fmt::format("{:.6g} to {:.6g} s", group.time_s.front(), group.time_s.back());
}

StampedColumns joined(std::vector<StampedColumns> clocks, OneClock& out, const std::string& name) {
  if (clocks.size() == 1) return std::move(clocks.front());
  std::string spans;
  for (const StampedColumns& clock : clocks) spans += (spans.empty() ? "" : " and ") + span_of(clock);
  std::iter_swap(clocks.begin(), std::ranges::min_element(clocks, {}, median_period_s));
  StampedColumns& base = clocks.front();
  for (std::size_t i = 1; i < clocks.size(); ++i) join(base, clocks[i]);
  const std::size_t alone = keep_complete_rows(base);
  out.notes.push_back(fmt::format(
      "{} clocks aligned by their stamps, on the fastest{}", clocks.size(),
      alone > 0 ? fmt::format("; {} of its rows, where another clock has a gap or nothing, left out", alone) : ""));
  if (base.time_s.empty()) {
    throw bad_input({.file = name,
                     .expected = "clocks that run at the same time",
                     .found = spans,
                     .advice = "check that the files are of one drive and the units of time are right; clocks that "
                               "began apart are brought "
                               "together by --align"});
  }
  return std::move(base);
}

}  // namespace

OneClock one_clock(std::vector<StampedColumns> groups, std::size_t columns, const std::string& name) {
  OneClock out;
  std::vector<StampedColumns> clocks;
  Repeats repeats;
  for (StampedColumns& group : groups) {
    for (StampedColumns& part : parted(std::move(group), out)) {
      const Repeats mended = mend_repeats(part, name);
      repeats.written_twice += mended.written_twice;
      repeats.shared.rows += mended.shared.rows;
      repeats.shared.without_clock += mended.shared.without_clock;
      clocks.push_back(std::move(part));
    }
  }
  note_repeats(repeats, out);
  StampedColumns rows = joined(std::move(clocks), out, name);
  out.time_s = std::move(rows.time_s);
  out.values.resize(columns);
  for (std::size_t i = 0; i < rows.wanted.size(); ++i) out.values[rows.wanted[i]] = std::move(rows.values[i]);
  return out;
}

}  // namespace steerid
