// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/prediction_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/log_source.hpp"
#include "log/one_record.hpp"
#include "log/stretch.hpp"
#include "log/units.hpp"

namespace steerid {
namespace {

constexpr const char* kTime = "time_s";
constexpr const char* kAngle = "angle_rad";
constexpr double kSameStamp_s = 1e-6;  // stamps of a log are microseconds

struct AngleInTime {
  std::vector<double> time_s;
  std::vector<double> angle_rad;
};

std::optional<std::size_t> place_of(std::string_view name, const std::vector<LogColumn>& columns) {
  const auto found = std::ranges::find(columns, name, &LogColumn::name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

AngleInTime read_angle(const std::filesystem::path& file) {
  const std::unique_ptr<LogSource> source = open_log(file, {});
  const auto time = place_of(kTime, source->columns());
  const auto angle = place_of(kAngle, source->columns());
  if (!source->time_is_a_column() || !time || !angle) {
    throw bad_input({.file = file.string(),
                     .line = source->header_line(),
                     .expected = fmt::format("the columns {} and {}", kTime, kAngle),
                     .found = fmt::format("no {}", time ? kAngle : kTime),
                     .advice = "write a CSV file with these two names above the rows"});
  }
  const Wanted wanted{.time = WantedColumn{.column = *time}, .columns = {{.column = *angle}}};
  OneClock rows = one_clock(source->read(wanted), 1, file.string());
  if (rows.left_out > 0) {
    throw bad_input({.file = file.string(),
                     .line = rows.first_incomplete_line,
                     .expected = fmt::format("a number for {} and {}", kTime, kAngle),
                     .found = "none",
                     .advice = "let the simulation answer every row"});
  }
  return {std::move(rows.time_s), std::move(rows.values.front())};
}

/// The first stamp of the record at which nothing near enough is predicted: there is no stamp of the prediction, and
/// those around it are farther apart than samples of a log may be, or its end is farther than that.
std::optional<double> unpredicted_s(const Record& record, const std::vector<double>& time_s) {
  constexpr double kApart_s = 1.01 / kLowestRateHz;  // rounding of stamps, as in a log
  if (time_s.empty()) return record.time_s.front();
  for (const double t : record.time_s) {
    const auto next = std::ranges::lower_bound(time_s, t - kSameStamp_s);
    const double apart_s = next == time_s.begin()      ? *next - t
                           : next == time_s.end()      ? t - *std::prev(next)
                           : *next <= t + kSameStamp_s ? 0
                                                       : *next - *std::prev(next);
    if (apart_s > kApart_s) return t;
  }
  return std::nullopt;
}

/// A prediction of which nothing can be made: angles in degrees, or of a simulator that diverges.
void expect_credible(const std::filesystem::path& file, const Record& record, const std::vector<double>& angle_rad) {
  const auto [least, most] = std::ranges::minmax(angle_rad);
  const auto [measured_least, measured_most] = std::ranges::minmax(record.angle_rad);
  const double turned_rad = most - least;
  const double measured_rad = measured_most - measured_least;
  if (turned_rad <= kDegreesPerRad / 2 * measured_rad) return;
  const bool degrees = turned_rad <= 2 * kDegreesPerRad * measured_rad;
  throw bad_input(
      {.file = file.string(),
       .column = kAngle,
       .expected = fmt::format("about as much motion as the record has, {:.3g} rad from end to end", measured_rad),
       .found = fmt::format("{:.3g}", turned_rad),
       .advice = degrees ? "write the angle in rad, if it is in degrees" : "see whether the simulation diverges"});
}

}  // namespace

std::vector<double> read_prediction(const std::filesystem::path& file, const Record& record) {
  const AngleInTime motion = read_angle(file);
  constexpr std::size_t kFewest = 4;  // of a cubic
  const bool few = motion.time_s.size() < kFewest;
  if (const auto missing_s = unpredicted_s(record, motion.time_s); few || missing_s) {
    throw bad_input(
        {.file = file.string(),
         .column = kAngle,
         .expected = fmt::format("an angle at every stamp of the record, from {} to {} s, or {:g} rows a second",
                                 record.time_s.front(), record.time_s.back(), kLowestRateHz),
         .found = few ? fmt::format("{} rows", motion.time_s.size()) : fmt::format("none at {} s", *missing_s),
         .advice = "run the simulation on all of the record, with the record's clock"});
  }
  std::vector<double> angle_rad = interpolated(motion.time_s, motion.angle_rad, record.time_s);
  expect_credible(file, record, angle_rad);
  return angle_rad;
}

}  // namespace steerid
