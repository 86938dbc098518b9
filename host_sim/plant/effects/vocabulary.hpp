// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The vocabulary of effects, in the order in which reports list them. A new effect is one file in this folder, one line
// here and one in vocabulary.cpp.
#pragma once

#include <span>
#include <string_view>

#include "plant/effects/effect.hpp"

namespace steerid {

namespace effect {
extern const EffectType coulomb_friction;
extern const EffectType stribeck_friction;
extern const EffectType asymmetric_friction;
extern const EffectType presliding_hysteresis;
extern const EffectType backlash;
extern const EffectType cubic_stiffness;
extern const EffectType quadratic_damping;
extern const EffectType delay;
extern const EffectType lag;
extern const EffectType torque_bias;
extern const EffectType torque_drift;
extern const EffectType compliance;
extern const EffectType reflex;
extern const EffectType time_varying_stiffness;
extern const EffectType hands_off;
extern const EffectType torque_ripple;
extern const EffectType gravity_imbalance;
extern const EffectType coarse_quantization;
extern const EffectType torque_saturation;
extern const EffectType periodic_disturbance;
extern const EffectType unmeasured_torque;
extern const EffectType sample_loss;
}  // namespace effect

/// Every effect, in the vocabulary's order.
[[nodiscard]] std::span<const EffectType* const> effects();

/// The effect called `id`; throws BadInput listing the ids when there is none.
[[nodiscard]] const EffectType& find_effect(std::string_view id);

/// Throws BadInput when the effects contradict each other (two that each say alone how the arm joins the wheel).
void check_compatible(std::span<const Effect> effects);

}  // namespace steerid
