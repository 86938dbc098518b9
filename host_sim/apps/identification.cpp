// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/identification.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "plant/wheel_arm.hpp"

namespace steerid {
namespace {

constexpr double kSurelyAboveZero = 2.0;  // standard deviations

}  // namespace

IdentifiedParameter from_published(const ParameterEstimate& published, double unit) {
  IdentifiedParameter parameter;
  // A quotient of whole numbers is the nearest number to the decimal fraction: it is written as short as it is exact.
  const double in_one = 1e6 / unit;
  parameter.value = published.value_micro / in_one;
  if (published.sd_micro != std::numeric_limits<std::int32_t>::max()) parameter.sd = published.sd_micro / in_one;
  parameter.state = published.state;
  return parameter;
}

FrequencyAnswer frequency_answer(const Identification& found) {
  const auto none = [](std::string reason) { return FrequencyAnswer{std::nullopt, std::move(reason), std::nullopt}; };
  for (const auto& [parameter, title] :
       {std::pair{found.inertia_kgm2, "inertia"}, std::pair{found.damping_nms_per_rad, "damping"},
        std::pair{found.stiffness_nm_per_rad, "stiffness"}}) {
    if (!std::isfinite(parameter.value)) return none(fmt::format("{} is not known", title));
    if (!is_identified(parameter.state)) return none(fmt::format("{} is {}", title, name(parameter.state)));
  }
  if (!(found.stiffness_nm_per_rad.value > kSurelyAboveZero * found.stiffness_nm_per_rad.sd)) {
    return none("stiffness cannot be told from zero");
  }

  const WheelArm wheel{found.inertia_kgm2.value, found.damping_nms_per_rad.value, found.stiffness_nm_per_rad.value};
  const NaturalFrequency frequency = natural_frequency(wheel);
  FrequencyAnswer answer{std::nullopt, std::string(frequency.reason()), wheel.damping_ratio()};
  if (frequency.defined == NaturalFrequency::Defined::kYes) answer.hz = frequency.hz;
  return answer;
}

}  // namespace steerid
