// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/compared_parts.hpp"

#include <algorithm>

namespace steerid {
const Hypothesis* ComparedParts::of(const EffectType* type) const {
  return type == nullptr ? nullptr : hypothesis_of(*type);
}

SpectralModel::Parts ComparedParts::with(const EffectType* type) const {
  SpectralModel::Parts all = parts;
  if (const Hypothesis* hypothesis = of(type); hypothesis != nullptr) all.push_back(hypothesis);
  return all;
}

bool ComparedParts::all_exact() const {
  return std::ranges::all_of(parts, [](const Hypothesis* part) { return part->exact_at_once(); });
}

bool ComparedParts::exact_with(const EffectType* type) const {
  const Hypothesis* hypothesis = of(type);
  return all_exact() && (hypothesis == nullptr || hypothesis->exact_at_once());
}

Eigen::VectorXd joined(const WheelArm& wheel, const std::vector<Effect>& effects) {
  std::vector<double> x = {wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad};
  for (const Effect& effect : effects) x.insert(x.end(), effect.values.begin(), effect.values.end());
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

Eigen::VectorXd point_of(const WheelArm& wheel, const std::vector<Effect>& effects) {
  return joined(wheel, compared_parts(effects).present);
}

const Whittle::Roles& roles_of(std::string_view id, const ComparedParts& there) {
  const auto timed = [](const Hypothesis* one) { return one != nullptr && one->timed(); };
  return timed(hypothesis_called(id)) || std::ranges::any_of(there.parts, timed) ? kSeen : kFitted;
}

ComparedParts compared_parts(const std::vector<Effect>& present) {
  ComparedParts there;
  for (const Effect& effect : present) {
    if (const Hypothesis* hypothesis = there.of(effect.type); hypothesis != nullptr) {
      there.parts.push_back(hypothesis);
      there.present.push_back(effect);
    } else {
      there.fixed.push_back(effect);
    }
  }
  return there;
}

}  // namespace steerid
