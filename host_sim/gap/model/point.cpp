// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/point.hpp"

#include <algorithm>
#include <iterator>

namespace steerid::gap {

Point Point::of(const Eigen::VectorXd& numbers, std::span<const Hypothesis* const> parts) {
  Point out{.wheel = {numbers[0], numbers[1], numbers[2]}};
  const double* next = numbers.data() + 3;
  for (const Hypothesis* part : parts) {
    Effect& effect = out.effects.emplace_back(part->type());
    std::copy_n(next, effect.values.size(), effect.values.begin());
    next += effect.values.size();
  }
  return out;
}

Eigen::VectorXd Point::numbers() const {
  std::vector<double> all = {wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad};
  for (const Effect& effect : effects) all.insert(all.end(), effect.values.begin(), effect.values.end());
  return Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all));
}

const Effect* Point::find(const EffectType& type) const {
  const auto found = std::ranges::find(effects, &type, &Effect::type);
  return found == effects.end() ? nullptr : &*found;
}

Point to_run(Point at) {
  for (Effect& effect : at.effects) effect.values = hypothesis_of(*effect.type)->to_run(effect.values, at.wheel);
  return at;
}

Parts hypotheses_of(const std::vector<Effect>& effects) {
  Parts all;
  for (const Effect& effect : effects) {
    if (const Hypothesis* hypothesis = hypothesis_of(*effect.type)) all.push_back(hypothesis);
  }
  return all;
}

}  // namespace steerid::gap
