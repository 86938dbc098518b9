// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/angle_clock.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <vector>

#include "log/log_format.hpp"
#include "log/read_between.hpp"
#include "log/record_quality.hpp"
#include "log/resample.hpp"

namespace steerid {

Record by_one_clock(Record record, double later_per_s, const std::optional<double>& in_step_s) {
  if (later_per_s == 0 || record.size() == 0) return record;
  const double from_s = in_step_s.value_or(record.time_s.front());
  Record read = record;
  for (const Channel channel : kAllChannels) values_of(read, channel).clear();
  for (const GapFreeRows rows : gap_free_rows(record)) {
    const std::span<const double> angle_rad = std::span(record.angle_rad).subspan(rows.begin, rows.size());
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      const double late_s = later_per_s * (record.time_s[i] - from_s);
      const double angle = read_between(angle_rad, static_cast<double>(i - rows.begin) + late_s * kResampledRateHz);
      if (!std::isfinite(angle)) continue;
      for (const Channel channel : kAllChannels) {
        const std::vector<double>& values = values_of(record, channel);
        if (!values.empty()) values_of(read, channel).push_back(values[i]);
      }
      read.angle_rad.back() = angle;
    }
  }
  return read;
}

std::string clock_drift_words(double later_per_s, double length_s, const std::optional<double>& in_step_s) {
  const std::string in_step = in_step_s ? fmt::format("in step at {:.6g} s, where a message slipped", *in_step_s)
                                        : "as if both had begun together";
  return fmt::format(
      "the clocks of angle and torque drift apart: the angle comes {} by {:.3g} us every second, by {:.3g} ms from the "
      "record's first sample to its last; it is read by the torques' clock, {}",
      later_per_s > 0 ? "later" : "earlier", 1e6 * std::abs(later_per_s), 1e3 * std::abs(later_per_s) * length_s,
      in_step);
}

}  // namespace steerid
