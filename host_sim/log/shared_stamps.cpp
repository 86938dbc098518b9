// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/shared_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

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

std::size_t shared_in(std::span<const double> time_s) {
  std::size_t shared = 0;
  for (std::size_t i = 1; i < time_s.size(); ++i) shared += time_s[i] == time_s[i - 1] ? 1 : 0;
  return shared;
}

/// Whether a steady clock explains the stamps, which are its times then.
bool take_steady_clock(std::span<double> time_s, double step_s) {
  constexpr std::size_t kFewest = 16;
  // Half a step by the rounding; of the line's ends a sixth, where sixteen stamps are off by up to that.
  constexpr double kOff = 2.0 / 3;
  if (time_s.size() < kFewest) return false;
  const auto count = static_cast<double>(time_s.size());
  const double middle = (count - 1) / 2;
  double mean_s = 0;
  for (const double one : time_s) mean_s += (one - time_s[0]) / count;
  double slope_s = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    slope_s += (static_cast<double>(i) - middle) * (time_s[i] - time_s[0]);
  }
  slope_s /= count * (count * count - 1) / 12;
  const double first_s = time_s[0];
  const auto at = [&](std::size_t i) { return first_s + mean_s + slope_s * (static_cast<double>(i) - middle); };
  double most_s = 0;  // by which a stamp is later: it is that of the rows up to the next one
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const double later_s = time_s[i] - at(i);
    if (!(std::abs(later_s) <= kOff * step_s)) return false;
    most_s = std::max(most_s, later_s);
  }
  for (std::size_t i = 0; i < time_s.size(); ++i) time_s[i] = at(i) + most_s;
  return true;
}

/// As many rows under every stamp but the ends': spread evenly they are of a steady clock, and exactly so.
bool shared_by_equally_many(std::span<const double> time_s, double step_s) {
  std::vector<std::size_t> counts;
  for (std::size_t begin = 0; begin < time_s.size();) {
    std::size_t end = begin + 1;
    while (end < time_s.size() && time_s[end] == time_s[begin]) ++end;
    constexpr double kRounding = 1e-6;
    if (end < time_s.size() && time_s[end] - time_s[begin] > (1 + kRounding) * step_s) return false;
    counts.push_back(end - begin);
    begin = end;
  }
  return counts.size() > 2 && std::ranges::all_of(counts.begin() + 1, counts.end() - 1, [&](std::size_t count) {
           return count == counts[1] && count >= counts.front() && count >= counts.back();
         });
}

void spread_evenly(std::span<double> time_s) {
  double step_s = 0;  // to the next stamp; behind the last one as before it
  for (std::size_t begin = 0; begin < time_s.size();) {
    std::size_t end = begin + 1;
    while (end < time_s.size() && time_s[end] == time_s[begin]) ++end;
    if (end < time_s.size()) step_s = time_s[end] - time_s[begin];
    const double stamp_s = time_s[begin];
    for (std::size_t i = begin + 1; i < end; ++i) {
      time_s[i] = stamp_s + step_s * static_cast<double>(i - begin) / static_cast<double>(end - begin);
    }
    begin = end;
  }
}

}  // namespace

SharedStamps spread_shared_stamps(std::vector<double>& time_s) {
  SharedStamps out{.rows = shared_in(time_s)};
  const double step_s = smallest_step_s(time_s);
  if (out.rows == 0 || !std::isfinite(step_s)) return out;
  const double period_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const double longest_s = longest_interval_s(std::max(step_s, period_s));
  out.by_steady_clock = true;
  for (std::size_t begin = 0; begin < time_s.size();) {
    std::size_t end = begin + 1;
    while (end < time_s.size() && time_s[end] - time_s[end - 1] <= longest_s) ++end;
    const std::span<double> stretch = std::span(time_s).subspan(begin, end - begin);
    begin = end;
    if (shared_in(stretch) == 0) continue;
    const bool equally = shared_by_equally_many(stretch, step_s);
    if (!equally && take_steady_clock(stretch, step_s)) continue;
    spread_evenly(stretch);
    out.by_steady_clock = out.by_steady_clock && equally;
  }
  return out;
}

}  // namespace steerid
