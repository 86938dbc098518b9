// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Damping that grows with speed: B2 |th'| th'.
//
// Signature: the decay is fast at large amplitude and slow at small amplitude; odd harmonics of rate.
// Source: J. P. Den Hartog, Mechanical Vibrations (1934), turbulent and orifice damping.
#include <cmath>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"quadratic_damping_nms2_per_rad2", 0.8, 0.0, 50.0, 0.1, "B2"},
};

class QuadraticDamping final : public PlantEffect {
 public:
  explicit QuadraticDamping(std::span<const double> values) : quadratic_(values[0]) {}

  [[nodiscard]] PlantTraits traits() const override {
    return {.turns_at_rest = true, .damping_per_rate_nms2_per_rad2 = 2 * quadratic_};
  }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    balance.torque_nm -= quadratic_ * std::abs(now.rate_rad_s) * now.rate_rad_s;
  }

 private:
  double quadratic_;
};

}  // namespace

constinit const EffectType quadratic_damping{
    .id = "quadratic_damping",
    .says = "damping that grows with speed",
    .parameters = kParameters,
    .in_plant = plant_effect<QuadraticDamping>,
};

}  // namespace steerid::effect
