// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "fit/segments.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steerid {
namespace {

constexpr double kBridgedPeriods = 3.5;  // two lost samples and some jitter

bool usable(const Record& record, std::size_t i) {
  return std::isfinite(record.time_s[i]) && std::isfinite(record.net_torque_nm(i)) &&
         std::isfinite(record.angle_rad[i]);
}

Segment make_segment(const Record& record, std::vector<std::size_t> sample, TorqueSignal::Between between) {
  std::vector<double> time_s;
  std::vector<double> angle_rad;
  std::vector<double> net_torque_nm;
  for (const std::size_t i : sample) {
    time_s.push_back(record.time_s[i]);
    angle_rad.push_back(record.angle_rad[i]);
    net_torque_nm.push_back(record.net_torque_nm(i));
  }
  TorqueSignal torque = TorqueSignal::from_samples(time_s, net_torque_nm, between);
  return {std::move(sample), std::move(time_s), std::move(angle_rad), std::move(net_torque_nm), std::move(torque)};
}

}  // namespace

double sample_period_s(const Record& record) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < record.size(); ++i) periods.push_back(record.time_s[i] - record.time_s[i - 1]);
  if (periods.empty()) return 0;
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

std::vector<Segment> gap_free_segments(const Record& record, TorqueSignal::Between between) {
  const double gap_s = kBridgedPeriods * sample_period_s(record);
  std::vector<Segment> segments;
  std::vector<std::size_t> current;
  const auto finish = [&] {
    if (current.size() >= kShortestSegment) segments.push_back(make_segment(record, std::move(current), between));
    current.clear();
  };
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!usable(record, i)) continue;
    if (!current.empty() && record.time_s[i] - record.time_s[current.back()] > gap_s) finish();
    current.push_back(i);
  }
  finish();
  return segments;
}

}  // namespace steerid
