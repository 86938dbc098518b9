// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The reader must end every text in a record that keeps its promises and that can be resampled, or in one BadInput of
// one line.
//
// The first line of the input is the option's text, `COLUMNS|SIGN`, either may be empty; the rest is the file.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "log/bad_input.hpp"
#include "log/log_reader.hpp"
#include "log/resample.hpp"
#include "promise.hpp"

namespace {

using steerid::fuzz::check_sentence;
using steerid::fuzz::promise;

void check_column(const steerid::Record& record, const std::vector<double>& column) {
  promise(column.size() == record.size(), "columns of equal length");
  for (const double value : column) promise(std::isfinite(value), "finite values");
}

void check_optional(const steerid::Record& record, std::uint8_t channel, const std::vector<double>& column) {
  if (record.has(channel)) return check_column(record, column);
  promise(column.empty(), "no values of an absent channel");
}

void check(const steerid::Record& record, const steerid::RecordQuality& quality) {
  promise(record.size() >= steerid::kFewestRows, "enough rows");
  promise(quality.rows == record.size(), "rows are counted");
  check_column(record, record.time_s);
  check_column(record, record.torque_driver_nm);
  check_column(record, record.torque_motor_nm);
  check_column(record, record.angle_rad);
  check_optional(record, steerid::kTorqueBarValid, record.torque_bar_nm);
  check_optional(record, steerid::kTorqueRimValid, record.torque_rim_nm);
  check_optional(record, steerid::kProbeValid, record.probe_nm);
  promise(record.equation() != steerid::Equation::kNone, "channels that identify something");
  for (std::size_t i = 1; i < record.size(); ++i) promise(record.time_s[i] > record.time_s[i - 1], "time increases");
  const std::vector<steerid::GapFreeRows> parts = steerid::gap_free_rows(record);
  promise(parts.size() == quality.gaps.size() + 1, "one segment more than gaps");
  promise(parts.front().begin == 0 && parts.back().end == record.size(), "segments hold every sample");
}

/// Values near the largest double may overflow in a filter, stamps may not go wrong.
void check_resampled(const steerid::Record& record) {
  promise(record.size() > 0, "nothing left is a BadInput");
  promise(record.angle_rad.size() == record.size(), "columns of equal length");
  for (std::size_t i = 1; i < record.size(); ++i) promise(record.time_s[i] > record.time_s[i - 1], "time increases");
}

steerid::LogFormat format_of(std::string_view options) {
  const std::size_t bar = options.find('|');
  const std::string_view columns = options.substr(0, bar);
  const std::string_view sign = bar == std::string_view::npos ? "" : options.substr(bar + 1);
  steerid::LogFormat format;
  if (!columns.empty()) format.columns = steerid::parse_columns(columns);
  if (!sign.empty()) format.reversed = steerid::parse_sign(sign);
  return format;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t newline = input.find('\n');
  const std::string_view file = newline == std::string_view::npos ? "" : input.substr(newline + 1);
  try {
    const steerid::LogFormat format = format_of(input.substr(0, newline));
    std::istringstream in{std::string(file)};
    steerid::RecordQuality quality;
    const steerid::Record record = steerid::read_log(in, "fuzz.csv", format, &quality);
    check(record, quality);
    check_resampled(steerid::resample_100hz(record).record);
  } catch (const steerid::BadInput& error) {
    check_sentence(error.what());
  } catch (const steerid::BadOption& error) {
    check_sentence(error.what());
  }
  return 0;
}
