#include "apps/identification.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace steerid {

IdentifiedParameter from_published(const ParameterEstimate& published) {
  IdentifiedParameter parameter;
  parameter.value = published.value_micro * 1e-6;
  if (published.sd_micro != std::numeric_limits<std::int32_t>::max()) parameter.sd = published.sd_micro * 1e-6;
  parameter.state = published.state;
  return parameter;
}

NaturalFrequency natural_frequency(const Identification& found) {
  const auto none = [](std::string reason) { return NaturalFrequency{std::nullopt, std::move(reason), std::nullopt}; };
  for (const auto& [parameter, title] :
       {std::pair{found.inertia_kgm2, "inertia"}, std::pair{found.damping_nms_per_rad, "damping"},
        std::pair{found.stiffness_nm_per_rad, "stiffness"}}) {
    if (!is_identified(parameter.state)) return none(fmt::format("{} is {}", title, name(parameter.state)));
  }
  const double inertia = found.inertia_kgm2.value;
  const double stiffness = found.stiffness_nm_per_rad.value;
  if (!(inertia > 0.0)) return none("inertia is not positive");
  // A stiffness within two standard deviations of zero may be none at all: a frequency made from it would be noise.
  if (!(stiffness > 2.0 * found.stiffness_nm_per_rad.sd)) return none("stiffness cannot be told from zero");

  const double ratio = found.damping_nms_per_rad.value / (2.0 * std::sqrt(inertia * stiffness));
  NaturalFrequency answer{std::nullopt, "", ratio};
  if (ratio >= 1.0) {
    answer.reason = fmt::format("overdamped: the damping ratio is {:.2f}, and from 1 on nothing oscillates", ratio);
  } else {
    answer.hz = std::sqrt((1.0 - ratio * ratio) * stiffness / inertia) / (2.0 * std::numbers::pi);
  }
  return answer;
}

}  // namespace steerid
