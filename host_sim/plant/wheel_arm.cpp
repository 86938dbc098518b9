// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/wheel_arm.hpp"

#include <cmath>
#include <numbers>

namespace steerid {

std::optional<double> WheelArm::damping_ratio() const {
  if (!(inertia_kgm2 > 0) || !(stiffness_nm_per_rad > 0)) return std::nullopt;
  return damping_nms_per_rad / (2 * std::sqrt(inertia_kgm2 * stiffness_nm_per_rad));
}

NaturalFrequency natural_frequency(const WheelArm& wheel) {
  using enum NaturalFrequency::Defined;
  if (!(wheel.inertia_kgm2 > 0)) return {kNoInertia, 0};
  if (!(wheel.stiffness_nm_per_rad > 0)) return {kNoStiffness, 0};
  const double ratio = *wheel.damping_ratio();
  if (!(std::abs(ratio) < 1)) return {kOverdamped, 0};
  const double undamped = std::sqrt(wheel.stiffness_nm_per_rad / wheel.inertia_kgm2);
  return {kYes, undamped * std::sqrt(1 - ratio * ratio) / (2 * std::numbers::pi)};
}

std::string_view NaturalFrequency::reason() const {
  switch (defined) {
    case Defined::kYes:
      return "";
    case Defined::kOverdamped:
      return "overdamped";
    case Defined::kNoStiffness:
      return "no stiffness";
    case Defined::kNoInertia:
      return "no inertia";
  }
  return "";
}

}  // namespace steerid
