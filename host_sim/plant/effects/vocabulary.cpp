// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/effects/vocabulary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "log/bad_input.hpp"

namespace steerid {
namespace {

constexpr std::array kEffects = {
    &effect::coulomb_friction,
    &effect::stribeck_friction,
    &effect::asymmetric_friction,
    &effect::presliding_hysteresis,
    &effect::backlash,
    &effect::cubic_stiffness,
    &effect::quadratic_damping,
    &effect::delay,
    &effect::lag,
    &effect::torque_bias,
    &effect::torque_drift,
    &effect::compliance,
    &effect::reflex,
    &effect::time_varying_stiffness,
    &effect::hands_off,
    &effect::torque_ripple,
    &effect::gravity_imbalance,
    &effect::coarse_quantization,
    &effect::torque_saturation,
    &effect::periodic_disturbance,
    &effect::unmeasured_torque,
    &effect::sample_loss,
};

std::size_t index_of(const Effect& effect, std::string_view name) {
  const auto parameters = effect.type->parameters;
  const auto found = std::ranges::find(parameters, name, &Parameter::name);
  if (found == parameters.end()) {
    std::vector<std::string_view> names;
    for (const Parameter& parameter : parameters) names.push_back(parameter.name);
    throw BadInput(
        fmt::format("{} has no parameter {}; it has {}", effect.type->id, in_quotes(name), fmt::join(names, ", ")));
  }
  return static_cast<std::size_t>(found - parameters.begin());
}

}  // namespace

std::span<const EffectType* const> effects() { return kEffects; }

const EffectType& find_effect(std::string_view id) {
  const auto found = std::ranges::find(kEffects, id, &EffectType::id);
  if (found != kEffects.end()) return **found;
  std::vector<std::string_view> ids;
  for (const EffectType* type : kEffects) ids.push_back(type->id);
  throw BadInput(fmt::format("there is no effect {}; the effects are {}", in_quotes(id), fmt::join(ids, ", ")));
}

void check_compatible(std::span<const Effect> effects) {
  const Effect* alone = nullptr;
  for (const Effect& effect : effects) {
    if (effect.type->joint == EffectType::Joint::kAlone && alone == nullptr) alone = &effect;
  }
  if (alone == nullptr) return;
  for (const Effect& effect : effects) {
    if (&effect == alone || effect.type->joint == EffectType::Joint::kNone) continue;
    throw BadInput(fmt::format("{} cannot be combined with {}: each says how the arm joins the wheel; keep one of them",
                               alone->type->id, effect.type->id));
  }
}

Effect::Effect(const EffectType& of) : type(&of) {
  for (const Parameter& parameter : of.parameters) values.push_back(parameter.preset);
}

double& Effect::at(std::string_view name) { return values[index_of(*this, name)]; }
double Effect::at(std::string_view name) const { return values[index_of(*this, name)]; }

}  // namespace steerid
