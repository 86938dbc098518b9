// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/shared_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "log/least_squares_line.hpp"
#include "log/record_quality.hpp"

namespace steerid {
namespace {

/// The smallest step between two stamps; infinite where there is one stamp.
double smallest_step_s(std::span<const double> time_s) {
  double step_s = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (time_s[i] > time_s[i - 1]) step_s = std::min(step_s, time_s[i] - time_s[i - 1]);
  }
  return step_s;
}

/// The first row of every stamp.
std::vector<std::size_t> first_rows(std::span<const double> time_s) {
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (i == 0 || time_s[i] != time_s[i - 1]) first.push_back(i);
  }
  return first;
}

/// Whether a steady clock explains the stamps, which are its times then.
bool take_steady_clock(std::span<double> time_s, double step_s) {
  constexpr std::size_t kFewest = 16;
  // Half a step by the rounding; of the line's ends a sixth, where sixteen stamps are off by up to that.
  constexpr double kOff = 2.0 / 3;
  if (time_s.size() < kFewest) return false;
  const std::vector<double> row = counted(time_s.size());
  const Line clock = least_squares_line(row, {time_s.begin(), time_s.end()});
  double most_s = 0;  // by which a stamp is later: it is that of the rows up to the next one
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double later_s = time_s[i] - clock.at(row[i]);
    if (!(std::abs(later_s) <= kOff * step_s)) return false;
    most_s = std::max(most_s, later_s);
  }
  for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] = clock.at(row[i]) + most_s;
  return true;
}

/// As many rows under every stamp but the ends': spread evenly they are of a steady clock, and exactly so.
bool shared_by_equally_many(std::span<const double> time_s, const std::vector<std::size_t>& first, double step_s) {
  constexpr double kRounding = 1e-6;
  if (first.size() < 3) return false;
  const std::size_t inside = first[2] - first[1];
  for (std::size_t k = 1; k < first.size(); ++k) {
    const std::size_t count = first[k] - first[k - 1];
    if (k == 1 ? count > inside : count != inside) return false;
    if (time_s[first[k]] - time_s[first[k - 1]] > (1 + kRounding) * step_s) return false;
  }
  return time_s.size() - first.back() <= inside;
}

void spread_evenly(std::span<double> time_s, const std::vector<std::size_t>& first) {
  double step_s = 0;  // to the next stamp; behind the last one as before it
  for (std::size_t k = 0; k < first.size(); ++k) {
    const double stamp_s = time_s[first[k]];
    const std::size_t end = k + 1 < first.size() ? first[k + 1] : time_s.size();
    if (end < time_s.size()) step_s = time_s[end] - stamp_s;
    const auto count = static_cast<double>(end - first[k]);
    for (std::size_t i = first[k] + 1; i < end; ++i) {
      time_s[i] = stamp_s + step_s * static_cast<double>(i - first[k]) / count;
    }
  }
}

}  // namespace

SharedStamps spread_shared_stamps(std::vector<double>& time_s) {
  SharedStamps out{.rows = time_s.size() - first_rows(time_s).size()};
  const double step_s = smallest_step_s(time_s);
  if (out.rows == 0 || !std::isfinite(step_s)) return out;
  const double period_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const double longest_s = longest_interval_s(std::max(step_s, period_s));
  for (std::size_t begin = 0; begin < time_s.size();) {
    std::size_t end = begin + 1;
    while (end < time_s.size() && time_s[end] - time_s[end - 1] <= longest_s) ++end;
    const std::span<double> stretch = std::span(time_s).subspan(begin, end - begin);
    begin = end;
    const std::vector<std::size_t> first = first_rows(stretch);
    const std::size_t shared = stretch.size() - first.size();
    const bool equally = shared_by_equally_many(stretch, first, step_s);
    if (shared == 0 || (!equally && take_steady_clock(stretch, step_s))) continue;
    spread_evenly(stretch, first);
    if (!equally) out.without_clock += shared;
  }
  return out;
}

}  // namespace steerid
