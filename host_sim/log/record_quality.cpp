// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/record_quality.hpp"

#include <algorithm>
#include <cmath>

namespace steerid {
namespace {

std::vector<double> intervals_of(const Record& record) {
  std::vector<double> intervals(record.size() < 2 ? 0 : record.size() - 1);
  for (std::size_t i = 0; i < intervals.size(); ++i) intervals[i] = record.time_s[i + 1] - record.time_s[i];
  return intervals;
}

/// The value that `share` of `values` stay below or at; reorders them.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace

RecordQuality quality_of(const Record& record) {
  RecordQuality quality;
  quality.rows = record.size();
  std::vector<double> intervals = intervals_of(record);
  quality.median_period_s = quantile(intervals, 0.5);
  const double longest = longest_interval_s(quality.median_period_s);
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double interval = record.time_s[i] - record.time_s[i - 1];
    if (interval > longest) quality.gaps.push_back({.start_s = record.time_s[i - 1], .length_s = interval});
  }
  std::erase_if(intervals, [&](double interval) { return interval > longest; });
  for (double& interval : intervals) interval = std::abs(interval - quality.median_period_s);
  quality.jitter_s = quantile(intervals, 0.95);
  return quality;
}

std::vector<GapFreeRows> gap_free_rows(const Record& record) {
  std::vector<GapFreeRows> found;
  if (record.size() == 0) return found;
  std::vector<double> intervals = intervals_of(record);
  const double longest = longest_interval_s(quantile(intervals, 0.5));
  std::size_t begin = 0;
  for (std::size_t i = 1; i < record.size(); ++i) {
    if (record.time_s[i] - record.time_s[i - 1] <= longest) continue;
    found.push_back({begin, i});
    begin = i;
  }
  found.push_back({begin, record.size()});
  return found;
}

}  // namespace steerid
