// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/compared_parts.hpp"

namespace steerid::gap {

Eigen::VectorXd joined(const WheelArm& wheel, const std::vector<Effect>& effects) {
  std::vector<double> x = {wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad};
  for (const Effect& effect : effects) x.insert(x.end(), effect.values.begin(), effect.values.end());
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

ComparedParts compared_parts(const std::vector<Effect>& present) {
  ComparedParts there;
  for (const Effect& effect : present) {
    if (const Hypothesis* hypothesis = hypothesis_of(*effect.type); hypothesis != nullptr) {
      there.parts.push_back(hypothesis);
      there.present.push_back(effect);
    } else {
      there.fixed.push_back(effect);
    }
  }
  return there;
}

}  // namespace steerid::gap
