// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/unit_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "apps/first_look.hpp"
#include "log/units.hpp"

namespace steerid {

std::string unit_words(const UnitCheck& check, const RecordQuality& seen) {
  if (seen.slide) return "";
  const ReadChannel& angle = seen.channel(Channel::kAngle);
  const bool torque_stated = std::ranges::any_of(kAllChannels, [&](Channel channel) {
    return quantity_of(channel) == Quantity::kTorque && seen.channel(channel).unit_by_option;
  });
  switch (check.verdict) {
    case UnitCheck::Verdict::kPlausible:
      break;
    case UnitCheck::Verdict::kTurnsTooFar:
      if (angle.unit_by_option) break;
      return fmt::format(
          "the wheel turns {:.3g} rad from end to end and no steering wheel turns beyond {:g}: {}; or, if it is no "
          "steering wheel and in rad, --columns angle={}:rad",
          check.turned_rad, kFarthestTurnRad,
          angle.whole_numbers ? fmt::format("the column has whole numbers, as counts are; say how much one is, "
                                            "--columns angle={}:deg*SCALE",
                                            angle.column)
                              : fmt::format("if it is in degrees, use --columns angle={}:deg, of counts or percent "
                                            "angle={}:deg*SCALE",
                                            angle.column, angle.column),
          angle.column);
    case UnitCheck::Verdict::kTooLight:
      if (angle.unit_by_option) break;
      return fmt::format(
          "J would be {:.2g} kg m2, and no steering wheel with an arm has less than {:g}: if {} is in degrees (J "
          "{:.2g} then), use --columns angle={}:deg, of counts or percent angle={}:deg*SCALE; if it is no steering "
          "wheel and in rad, --columns angle={}:rad",
          check.inertia_kgm2, kLightestKgm2, angle.column, kDegreesPerRad * check.inertia_kgm2, angle.column,
          angle.column, angle.column);
    case UnitCheck::Verdict::kTooHeavy: {
      if (torque_stated) break;
      const bool counts = std::ranges::any_of(kAllChannels, [&](Channel channel) {
        const ReadChannel& read = seen.channel(channel);
        return quantity_of(channel) == Quantity::kTorque && !read.column.empty() && read.whole_numbers;
      });
      return fmt::format(
          "J would be {:.2g} kg m2, and no steering wheel with an arm has more than {:g}: {}? Say so with --columns "
          "CHANNEL=COLUMN:mnm, or :nm*SCALE for counts and percent, or :nm if they are in Nm and it is no steering "
          "wheel",
          check.inertia_kgm2, kHeaviestKgm2,
          counts ? "a torque has whole numbers only: are they counts, percent or mNm"
                 : "are its torques in Nm, or in mNm, counts or percent");
    }
    case UnitCheck::Verdict::kExchanged: {
      if (angle.unit_by_option && torque_stated) break;
      const std::string_view torque = channel_name(check.exchanged);
      return fmt::format(
          "angle and {} are named for each other: as they are there is no steering wheel, exchanged it has J {:.2g} kg "
          "m2; use --columns angle={}:rad,{}={}:nm, or :deg where it is, or state both units as they are if it is no "
          "steering wheel",
          torque, check.inertia_kgm2, seen.channel(check.exchanged).column, torque, angle.column);
    }
  }
  return "";
}

std::vector<std::string> read_notes(const Record& record, const RecordQuality& seen) {
  std::vector<std::string> notes = seen.notes;
  std::string doubt = unit_words(check_units(record), seen);
  if (doubt.empty()) doubt = first_look(record, std::nullopt).doubt;
  if (!doubt.empty()) notes.push_back(std::string(kNotCredible) + doubt);
  return notes;
}

std::string delay_words(const TorqueDelay& delay) {
  if (!delay.shown) return "";
  return fmt::format(
      "the torques are {:.3g} ms {} than the angle, by what a wheel explains of them: a delay in one of "
      "the sensors makes J, B and C wrong",
      1000 * std::abs(delay.late_s), delay.late_s > 0 ? "later" : "earlier");
}

}  // namespace steerid
