// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/driver_timeline.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "log/reading_time.hpp"

namespace steerid {
namespace {

constexpr std::size_t kLinesShown = 8;
constexpr const char* kNoWheel = "this is no steering wheel";

std::string words(const DriverSpan& span) {
  std::string text = name(span.state);
  if (span.hands != HandCount::kUnknown) text += fmt::format(", hands: {}", name(span.hands));
  return text;
}

/// Without what adding periods has left behind: logs tell a microsecond.
double in_whole_us(double stamp_s) { return std::round(1e6 * stamp_s) / 1e6; }

}  // namespace

DriverTimeline driver_timeline(const FirmwareRun& run) {
  DriverTimeline timeline;
  if (!run.units.steering_wheel()) return timeline;
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const Estimate& now = run.estimates[i];
    if (!timeline.empty()) timeline.back().to_s = run.time_s[i];
    if (timeline.empty() || timeline.back().state != now.driver || timeline.back().hands != now.hands) {
      timeline.push_back({run.time_s[i], run.time_s[i], now.driver, now.hands});
    }
  }
  return timeline;
}

std::string driver_lines(const DriverTimeline& timeline) {
  std::string text = "driver, as the firmware loop told it\n";
  if (timeline.empty()) return text + fmt::format("  {:<18}none: {}\n", "state", kNoWheel);
  text += fmt::format("  {:<18}{}\n", "at the end", words(timeline.back()));
  const double whole_s = timeline.back().to_s - timeline.front().from_s;
  std::string shares;
  for (const DriverState state :
       {DriverState::kHandsOff, DriverState::kRelaxed, DriverState::kBraced, DriverState::kUnknown}) {
    double length_s = 0;
    for (const DriverSpan& span : timeline) length_s += span.state == state ? span.to_s - span.from_s : 0;
    if (length_s > 0)
      shares += fmt::format("{}{} {:.3g} %", shares.empty() ? "" : ", ", name(state), 100 * length_s / whole_s);
  }
  text += fmt::format("  {:<18}{}\n", "of the time", shares);
  const std::size_t first = timeline.size() > kLinesShown ? timeline.size() - kLinesShown : 0;
  if (first > 0) text += fmt::format("  {} earlier changes are in the answer of --json\n", first);
  const double zero_s = reading_zero_s(timeline.front().from_s);
  for (std::size_t i = first; i < timeline.size(); ++i) {
    text += fmt::format("  {:<17} {}\n",
                        fmt::format("{:.1f} to {:.1f} s", timeline[i].from_s - zero_s, timeline[i].to_s - zero_s),
                        words(timeline[i]));
  }
  return text;
}

nlohmann::ordered_json driver_json(const DriverTimeline& timeline) {
  if (timeline.empty()) return {{"state", nullptr}, {"hands", nullptr}, {"reason", kNoWheel}};
  nlohmann::ordered_json spans = nlohmann::ordered_json::array();
  for (const DriverSpan& span : timeline) {
    spans.push_back({{"from_s", in_whole_us(span.from_s)},
                     {"to_s", in_whole_us(span.to_s)},
                     {"state", name(span.state)},
                     {"hands", name(span.hands)}});
  }
  const DriverSpan& last = timeline.back();
  return {{"state", name(last.state)}, {"hands", name(last.hands)}, {"timeline", std::move(spans)}};
}

}  // namespace steerid
