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

Record by_one_clock(Record record, const AngleClock& clock, const std::optional<double>& in_step_s) {
  if (clock.is_the_torques() || record.size() == 0) return record;
  const double from_s = in_step_s.value_or(record.time_s.front());
  Record read = record;
  for (const Channel channel : kAllChannels) values_of(read, channel).clear();
  for (const GapFreeRows rows : gap_free_rows(record)) {
    const std::span<const double> angle_rad = std::span(record.angle_rad).subspan(rows.begin, rows.size());
    for (std::size_t i = rows.begin; i < rows.end; ++i) {
      const double late_s = clock.late_s + clock.later_per_s * (record.time_s[i] - from_s);
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

std::vector<std::string> clock_notes(const AngleClock& clock, double length_s, const std::optional<double>& in_step_s) {
  const auto later = [](double by) { return by > 0 ? "later" : "earlier"; };
  std::vector<std::string> notes;
  if (clock.later_per_s != 0) {
    const std::string in_step = in_step_s ? fmt::format("in step at {:.6g} s, where a message slipped", *in_step_s)
                                          : "as if both had begun together";
    const double per_s = std::abs(clock.later_per_s);
    notes.push_back(fmt::format(
        "the clocks of angle and torque drift apart: the angle comes {} by {:.3g} us every second, by {:.3g} ms from "
        "the record's first sample to its last; it is read by the torques' clock, {}",
        later(clock.later_per_s), 1e6 * per_s, 1e3 * per_s * length_s, in_step));
  }
  if (clock.late_s != 0) {
    notes.push_back(fmt::format(
        "the angle comes {} by {:.2g} ms than the rows have it against the torques, less than they tell: it is read so",
        later(clock.late_s), 1e3 * std::abs(clock.late_s)));
  }
  return notes;
}

}  // namespace steerid
