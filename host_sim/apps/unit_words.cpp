// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/unit_words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace steerid {
namespace {

constexpr double kDegreesPerRad = 180 / std::numbers::pi;

}  // namespace

std::string unit_words(const UnitCheck& check, const RecordQuality& seen) {
  if (seen.slide) return "";
  switch (check.verdict) {
    case UnitCheck::Verdict::kPlausible:
      break;
    case UnitCheck::Verdict::kTurnsTooFar:
      if (seen.angle_unit_by_option) break;
      return fmt::format(
          "the wheel turns {:.3g} rad from end to end and no steering wheel turns beyond {:g}: {}; or, if it is no "
          "steering wheel and in rad, --columns angle={}:rad",
          check.turned_rad, kFarthestTurnRad,
          seen.angle_in_whole_numbers
              ? fmt::format(
                    "the column has whole numbers, as counts are; say how much one is, --columns angle={}:deg*SCALE",
                    seen.angle_column)
              : fmt::format("if it is in degrees, use --columns angle={}:deg", seen.angle_column),
          seen.angle_column);
    case UnitCheck::Verdict::kTooLight:
      if (seen.angle_unit_by_option) break;
      return fmt::format(
          "J would be {:.2g} kg m2, and no steering wheel with an arm has less than {:g}: if {} is in degrees (J "
          "{:.2g} "
          "then), use --columns angle={}:deg; if it is no steering wheel and in rad, --columns angle={}:rad",
          check.inertia_kgm2, kLightestKgm2, seen.angle_column, kDegreesPerRad * check.inertia_kgm2, seen.angle_column,
          seen.angle_column);
    case UnitCheck::Verdict::kTooHeavy:
      if (seen.torque_unit_by_option) break;
      return fmt::format(
          "J would be {:.2g} kg m2, and no steering wheel with an arm has more than {:g}: are its torques in Nm, or in "
          "mNm, counts or percent? Say so with --columns CHANNEL=COLUMN:mnm, or :nm*SCALE for counts and percent, or "
          ":nm if they are in Nm and it is no steering wheel",
          check.inertia_kgm2, kHeaviestKgm2);
  }
  return "";
}

std::string delay_words(const TorqueDelay& delay) {
  if (!delay.shown) return "";
  return fmt::format(
      "the torques are {:.0f} ms {} than the angle, by what a wheel explains of them: a delay in one of "
      "the sensors makes J, B and C wrong",
      1000 * std::abs(delay.late_s), delay.late_s > 0 ? "later" : "earlier");
}

}  // namespace steerid
