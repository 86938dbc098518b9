// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A driver's co-contraction drifts while he holds the wheel: C swings by a share of itself, up and down, once in 16 s.
#pragma once

#include <cstdint>
#include <vector>

#include "plant/effects/vocabulary.hpp"
#include "plant/plant.hpp"
#include "sensors/random.hpp"

namespace steerid {

inline constexpr double kSwing_s = 16.0;

/// What a plant is given for it; nothing for a swing of 0. The seed decides where in its swing C begins.
[[nodiscard]] inline std::vector<Effect> stiffness_drift(double swing, std::uint64_t seed) {
  constexpr std::uint64_t kStream = 321;
  if (swing == 0) return {};
  Effect effect(effect::time_varying_stiffness);
  effect.at("shape") = 2;
  effect.at("stiffness_ratio") = 1 + swing;
  effect.at("length_s") = kSwing_s;
  effect.at("time_s") = kSwing_s * Random(seed, kStream).uniform();
  return {effect};
}

}  // namespace steerid
