// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/driver_timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "fit/unit_check.hpp"
#include "identifier/parameters.hpp"
#include "log/reading_time.hpp"

namespace steerid {
namespace {

constexpr std::size_t kLinesShown = 8;
constexpr const char* kNoWheel = "this is no steering wheel";
constexpr double kDeviations = 2;

bool arm_alone(Equation equation) { return equation == Equation::kRim || equation == Equation::kDriverRim; }

/// kg m2: the least that J of a wheel with an arm can be, of a rim transducer that of the arm alone.
double lightest(Equation equation) {
  const BareWheel<double> wheel;
  return arm_alone(equation) ? kLightestKgm2 : wheel.value(kInertia) - kDeviations * wheel.spread(kInertia);
}

/// Why nothing that the firmware told of a driver means one; empty where there is no reason.
std::string no_driver(const FirmwareRun& run, const Identification& found) {
  if (!run.units.steering_wheel()) return kNoWheel;
  if (!found.doubt.empty()) return "the record is in doubt";
  const IdentifiedParameter& inertia = found.inertia_kgm2;
  const bool known = inertia.state == ParameterState::kValid || inertia.state == ParameterState::kHolding;
  const double least = lightest(found.equation);
  if (known && inertia.value + kDeviations * inertia.sd < least) {
    return fmt::format("{}: J of {:.2g} kg m2 is less than the {:.2g} of the lightest {}", kNoWheel, inertia.value,
                       least, arm_alone(found.equation) ? "arm" : "wheel alone");
  }
  const bool told = std::ranges::any_of(run.estimates, [](const Estimate& estimate) {
    return estimate.driver != DriverState::kUnknown || estimate.hands != HandCount::kUnknown;
  });
  if (told) return "";
  const bool valid = std::ranges::any_of(
      run.estimates, [](const Estimate& estimate) { return estimate.stiffness.state == ParameterState::kValid; });
  return valid ? "at no time did C, or the torsion bar, tell for long enough who holds the wheel, as of fingers, or of "
                 "an "
                 "arm between relaxed and braced"
               : "at no time was C valid";
}

std::string words(const DriverSpan& span) {
  std::string text = name(span.state);
  if (span.hands != HandCount::kUnknown) text += fmt::format(", hands: {}", name(span.hands));
  return text;
}

/// Without what adding periods has left behind: logs tell a microsecond.
double in_whole_us(double stamp_s) { return std::round(1e6 * stamp_s) / 1e6; }

}  // namespace

DriverTimeline driver_timeline(const FirmwareRun& run, const Identification& found) {
  DriverTimeline timeline{.spans = {}, .none_since = no_driver(run, found)};
  if (!timeline.none_since.empty()) return timeline;
  std::vector<DriverSpan>& spans = timeline.spans;
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const Estimate& now = run.estimates[i];
    if (!spans.empty()) spans.back().to_s = run.time_s[i];
    if (spans.empty() || spans.back().state != now.driver || spans.back().hands != now.hands) {
      spans.push_back({run.time_s[i], run.time_s[i], now.driver, now.hands});
    }
  }
  return timeline;
}

void forget_driver(FirmwareRun& run) {
  for (Estimate& estimate : run.estimates) {
    estimate.driver = DriverState::kUnknown;
    estimate.hands = HandCount::kUnknown;
  }
}

std::string driver_lines(const DriverTimeline& timeline) {
  if (!timeline.none_since.empty()) return fmt::format("nothing is told of a driver: {}\n", timeline.none_since);
  const std::vector<DriverSpan>& spans = timeline.spans;
  std::string text = "driver, as the firmware loop told it\n";
  text += fmt::format("  {:<18}{}\n", "at the end", words(spans.back()));
  const double whole_s = spans.back().to_s - spans.front().from_s;
  std::string shares;
  for (const DriverState state :
       {DriverState::kHandsOff, DriverState::kRelaxed, DriverState::kBraced, DriverState::kUnknown}) {
    double length_s = 0;
    for (const DriverSpan& span : spans) length_s += span.state == state ? span.to_s - span.from_s : 0;
    if (length_s > 0)
      shares += fmt::format("{}{} {:.3g} %", shares.empty() ? "" : ", ", name(state), 100 * length_s / whole_s);
  }
  text += fmt::format("  {:<18}{}\n", "of the time", shares);
  const std::size_t first = spans.size() > kLinesShown ? spans.size() - kLinesShown : 0;
  if (first > 0) text += fmt::format("  {} earlier changes are in the answer of --json\n", first);
  const double zero_s = reading_zero_s(spans.front().from_s);
  for (std::size_t i = first; i < spans.size(); ++i) {
    text += fmt::format("  {:<17} {}\n",
                        fmt::format("{:.1f} to {:.1f} s", spans[i].from_s - zero_s, spans[i].to_s - zero_s),
                        words(spans[i]));
  }
  return text;
}

nlohmann::ordered_json driver_json(const DriverTimeline& timeline) {
  if (!timeline.none_since.empty()) {
    return {{"state", nullptr}, {"hands", nullptr}, {"reason", timeline.none_since}};
  }
  nlohmann::ordered_json spans = nlohmann::ordered_json::array();
  for (const DriverSpan& span : timeline.spans) {
    spans.push_back({{"from_s", in_whole_us(span.from_s)},
                     {"to_s", in_whole_us(span.to_s)},
                     {"state", name(span.state)},
                     {"hands", name(span.hands)}});
  }
  const DriverSpan& last = timeline.spans.back();
  return {{"state", name(last.state)}, {"hands", name(last.hands)}, {"timeline", std::move(spans)}};
}

}  // namespace steerid
