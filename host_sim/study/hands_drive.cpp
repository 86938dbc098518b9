// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/hands_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "sensors/random.hpp"
#include "study/labelled_drive.hpp"

namespace steerid {
namespace {

constexpr double kFilter_hz = 1;
constexpr double kSameAlarm_s = 5;
constexpr double kTold_s = 6;  // after a release 99 % are to be told
constexpr std::uint64_t kHandsStream = 310;
constexpr double kBarOffset_nm = 0.2;  // by which a bar's sensor is off at most
constexpr double kNever = std::numeric_limits<double>::infinity();

enum class Held : std::uint8_t { kRelease, kHolds, kBraces };

ColumnScenario scenario_of(Held held, std::uint64_t seed, std::uint64_t number, double wheel_friction_nm) {
  ColumnScenario scenario = drawn_scenario(
      {.probe_nm = kHandsProbe_nm, .duration_s = kHandsDrive_s, .wheel_friction_nm = wheel_friction_nm}, seed, number);
  Random random(seed * 1'000'003 + number, kHandsStream);
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  Column& column = scenario.column;
  column.aligning_stiffness_nm_per_rad = between(2, 25);
  if (on_rough_road(number)) {
    column.road_rms_nm = between(1, 2.5);
    column.road_corner_hz = 8;
  }
  DriveSettings& drive = scenario.drive;
  drive.steering_rad = std::min(drive.steering_rad, between(0.01, 0.1));
  if (held == Held::kRelease) drive.releases = {{.at_s = between(18, 25), .length_s = kHandsOff_s}};
  if (held == Held::kHolds && by_two_fingers(number)) {
    drive.arm = {column.wheel_inertia_kgm2 + between(0.003, 0.01),
                 column.wheel_damping_nms_per_rad + between(0.05, 0.2), between(0.8, 3)};
    drive.steering_rad = between(0.01, 0.1);
  }
  if (held == Held::kBraces) {
    drive.arm.stiffness_nm_per_rad = between(6, 11);
    drive.change = {.course = ArmCourse::kRamp,
                    .stiffness_nm_per_rad = 3 * drive.arm.stiffness_nm_per_rad,
                    .at_s = between(18, 25),
                    .length_s = 1};
  }
  scenario.sensors.torque_bar.bias.offset = between(-kBarOffset_nm, kBarOffset_nm);
  return scenario;
}

LabelledDrive drawn(Held held, std::uint64_t seed, std::uint64_t number, double wheel_friction_nm = 0) {
  return drive_of(scenario_of(held, seed, number, wheel_friction_nm), Known::kBarAndProbe, Bound::kNone);
}

std::size_t row_at(double time_s) { return static_cast<std::size_t>(std::llround(time_s / kTickS)); }

/// For how long each detector has said so without a break, in ticks; row by row.
using Says = std::array<std::vector<std::int32_t>, kHandsDetectors>;

Says says_of(const LabelledDrive& drive, const std::vector<Estimate>& estimates) {
  Says says;
  const double share = 1 - std::exp(-2 * std::numbers::pi * kFilter_hz * kTickS);
  double filtered_nm = 0;
  for (std::size_t k = 0; k < drive.record.size(); ++k) {
    filtered_nm += share * (drive.record.torque_bar_nm[k] - filtered_nm);
    for (std::size_t d = 0; d < kHandsDetectors; ++d) {
      const bool off =
          d == 0 ? estimates[k].driver == DriverState::kHandsOff : std::abs(filtered_nm) < kBarThresholds_nm[d - 1];
      says[d].push_back(off ? (k > 0 ? says[d][k - 1] : 0) + 1 : 0);
    }
  }
  return says;
}

bool told(const std::vector<std::int32_t>& says, std::size_t row, double for_s) {
  return says[row] > 0 && says[row] * kTickS >= for_s;
}

StateTicks ticks_of(const std::vector<Estimate>& estimates, std::size_t from, std::size_t end) {
  StateTicks ticks{};
  for (std::size_t k = from; k < std::min(end, estimates.size()); ++k) ++ticks[static_cast<int>(estimates[k].driver)];
  return ticks;
}

ToldRelease release_of(const LabelledDrive& drive, double friction_told_nm = 0) {
  const std::vector<Estimate> estimates = estimates_of<float>(drive.record, friction_told_nm);
  const Says says = says_of(drive, estimates);
  const double usual = drive.truth.front().stiffness_nm_per_rad;
  const auto first = [&](std::size_t k, auto holds) {
    while (k < drive.truth.size() && !holds(drive.truth[k].stiffness_nm_per_rad / usual)) ++k;
    return k;
  };
  const std::size_t leaves = first(0, [](double share) { return share <= 0.95; });
  const std::size_t off = first(leaves, [](double share) { return share <= 0.05; });
  const std::size_t back = first(off, [](double share) { return share >= 0.05; });
  ToldRelease found;
  for (std::size_t d = 0; d < kHandsDetectors; ++d) {
    for (std::size_t h = 0; h < kSaidFor_s.size(); ++h) {
      std::size_t k = off;
      while (k < back && !told(says[d], k, kSaidFor_s[h])) ++k;
      found.told_after_s[d][h] = k < back ? static_cast<double>(k - leaves) * kTickS : kNever;
    }
  }
  found.ticks = ticks_of(estimates, leaves + row_at(kTold_s), back);
  return found;
}

}  // namespace

std::string hands_detector_name(std::size_t detector) {
  return detector == 0 ? "steerid" : fmt::format("bar below {:g} Nm", kBarThresholds_nm[detector - 1]);
}

ToldRelease drawn_release(std::uint64_t seed, std::uint64_t number) {
  return release_of(drawn(Held::kRelease, seed, number));
}

ToldRelease held_out_release(std::uint64_t seed, std::uint64_t number, const WheelFriction& friction) {
  return release_of(held_out_drive({.story = ArmStory::kHandsLeave,
                                    .steering_rad = 0.05,
                                    .probe_nm = kHandsProbe_nm,
                                    .duration_s = kHandsDrive_s,
                                    .wheel_friction_nm = friction.there_nm},
                                   seed, number),
                    friction.told_nm);
}

HeldWheel held_wheel(std::uint64_t seed, std::uint64_t number, const WheelFriction& friction) {
  const LabelledDrive drive = drawn(Held::kHolds, seed, number, friction.there_nm);
  const std::vector<Estimate> estimates = estimates_of<float>(drive.record, friction.told_nm);
  const Says says = says_of(drive, estimates);
  HeldWheel found;
  for (std::size_t d = 0; d < kHandsDetectors; ++d) {
    for (std::size_t h = 0; h < kSaidFor_s.size(); ++h) {
      double quiet_s = kSameAlarm_s;
      for (std::size_t k = row_at(kHandsSettling_s); k < says[d].size(); ++k) {
        const bool alarm = told(says[d], k, kSaidFor_s[h]);
        found.alarms[d][h] += alarm && quiet_s >= kSameAlarm_s;
        found.alarmed_s[d][h] += alarm ? kTickS : 0;
        quiet_s = alarm ? 0 : quiet_s + kTickS;
      }
    }
  }
  found.ticks = ticks_of(estimates, row_at(kHandsSettling_s), estimates.size());
  return found;
}

double braced_after_s(std::uint64_t seed, std::uint64_t number, Rack rack) {
  ColumnScenario scenario = scenario_of(Held::kBraces, seed, number, 0);
  if (rack == Rack::kWithoutFriction) scenario.column.rack_friction_nm = 0;
  const LabelledDrive drive = drive_of(scenario, Known::kBarAndProbe, Bound::kNone);
  const std::vector<Estimate> estimates = estimates_of<float>(drive.record);
  const double usual = drive.truth.front().stiffness_nm_per_rad;
  std::size_t begins = 0;
  while (begins < drive.truth.size() && drive.truth[begins].stiffness_nm_per_rad <= usual) ++begins;
  for (std::size_t k = begins; k < estimates.size(); ++k) {
    if (estimates[k].driver == DriverState::kBraced) return static_cast<double>(k - begins) * kTickS;
  }
  return kNever;
}

}  // namespace steerid
