// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The weight of an unbalanced wheel or of the resting arm: m g r sin(th + phi).
//
// Signature: m g r sin(phi) is a torque offset and m g r cos(phi) a stiffness; only large angles tell them from a bias
// and from C. Source: the physical pendulum.
//
// A wheel's weight is 0.05 to 0.3 Nm, a hanging leg's 0.3, a bench pendulum's some Nm (docs/real_records.md). Where
// nothing was known of it, a weight of 23 Nm and a C that is as much too large explained an angle's offset.
#include <cmath>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"weight_torque_nm", 0.7, 0.0, 30.0, 0.05, "m g r", {.mean = 0, .sd = 2}},
    Parameter{"phase_rad", 0.6, -3.2, 3.2, 0.1, "phi, where the weight hangs at angle zero"},
};

class GravityImbalance final : public PlantEffect {
 public:
  explicit GravityImbalance(std::span<const double> values) : weight_nm_(values[0]), phase_rad_(values[1]) {}
  [[nodiscard]] PlantTraits traits() const override { return {.added_stiffness_nm_per_rad = weight_nm_}; }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    balance.torque_nm -= weight_nm_ * std::sin(now.angle_rad + phase_rad_);
  }

 private:
  double weight_nm_;
  double phase_rad_;
};

}  // namespace

constinit const EffectType gravity_imbalance{
    .id = "gravity_imbalance",
    .says = "the weight of an unbalanced wheel or of the resting arm",
    .parameters = kParameters,
    .in_plant = plant_effect<GravityImbalance>,
};

}  // namespace steerid::effect
