// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/comparison/dry_friction_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

/// The candidate's parameters with another effect in the place of its own.
Eigen::VectorXd with_instead(const Candidate& candidate, const Effect& effect) {
  return point_at(origin_of(candidate.fit.x, *candidate.type), effect.values);
}

}  // namespace

bool dry_friction(std::string_view id) {
  return id == "coulomb_friction" || id == "stribeck_friction" || id == "asymmetric_friction";
}

Effect with_bristles(Effect effect, const WheelArm& wheel) {
  constexpr double kSwing_hz = 20;
  double breakaway_nm = 0;
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    if (effect.type->parameters[i].name.ends_with("_nm")) breakaway_nm = std::max(breakaway_nm, effect.values[i]);
  }
  effect.at("bristle_rad") = breakaway_nm / (wheel.inertia_kgm2 * std::pow(2 * std::numbers::pi * kSwing_hz, 2));
  return effect;
}

Eigen::VectorXd with_bristles(const Candidate& candidate) {
  return with_instead(candidate, with_bristles(*fitted_effect(candidate), wheel_of(candidate.fit.x)));
}

Eigen::VectorXd as_coulomb(const EffectType& type, const Candidate& coulomb) {
  const Effect given = *fitted_effect(coulomb);
  Effect effect(type);
  effect.at("bristle_rad") = given.at("bristle_rad");
  if (type.id == "stribeck_friction") {
    effect.at("breakaway_ratio") = 1;
    effect.at("friction_nm") = given.at("friction_nm");
  } else {
    effect.at("friction_forward_nm") = given.at("friction_nm");
    effect.at("friction_backward_nm") = given.at("friction_nm");
  }
  return with_instead(coulomb, effect);
}

Eigen::VectorXd coulomb_of(const Candidate& richer) {
  const Effect given = *fitted_effect(richer);
  Effect effect(effect::coulomb_friction);
  effect.at("bristle_rad") = given.at("bristle_rad");
  effect.at("friction_nm") = richer.id == "asymmetric_friction"
                                 ? (given.at("friction_forward_nm") + given.at("friction_backward_nm")) / 2
                                 : given.at("friction_nm");
  return with_instead(richer, effect);
}

Eigen::VectorXd as_kind(const EffectType& type, const Candidate& other) {
  Candidate plain = other;
  if (other.id != "coulomb_friction") {
    plain.fit.x = coulomb_of(other);
    plain.id = effect::coulomb_friction.id;
    plain.type = &effect::coulomb_friction;
  }
  return &type == plain.type ? plain.fit.x : as_coulomb(type, plain);
}

Eigen::VectorXd levelled(const Candidate& richer) {
  Effect effect = *fitted_effect(richer);
  if (richer.id == "stribeck_friction") {
    effect.at("friction_nm") *= (1 + effect.at("breakaway_ratio")) / 2;
    effect.at("breakaway_ratio") = 1;
  } else {
    const double mean = (effect.at("friction_forward_nm") + effect.at("friction_backward_nm")) / 2;
    effect.at("friction_forward_nm") = effect.at("friction_backward_nm") = mean;
  }
  return with_instead(richer, effect);
}

}  // namespace steerid
