// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction that differs between the two directions: Fp for th' > 0, -Fm for th' < 0, anything between at rest.
//
// It is (Fp + Fm)/2 in both directions beside a torque offset of (Fp - Fm)/2, moving and at rest, where either lets the
// torque be anything from -Fm to Fp: no drive tells the two apart. Source: as coulomb_friction; asymmetry is usual with
// preloaded gears.
#include <algorithm>
#include <cmath>

#include "plant/effects/dry_friction.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"friction_forward_nm", 0.3, 0.0, 50.0, 0.05, "dry friction turning counter-clockwise"},
    Parameter{"friction_backward_nm", 0.8, 0.0, 50.0, 0.05, "dry friction turning clockwise"},
    kBristle,
};

class AsymmetricFriction final : public DryFriction {
 public:
  AsymmetricFriction(std::span<const double> values, const RunSetting& setting)
      : DryFriction(std::max(values[0], values[1]), values[2], setting),
        forward_nm_(values[0]),
        backward_nm_(values[1]) {}
  [[nodiscard]] double dry_friction_nm(int direction, double) const override {
    return direction > 0 ? forward_nm_ : backward_nm_;
  }

 private:
  double forward_nm_;
  double backward_nm_;
};

/// Bristles of one stiffness bend as far as the larger friction bends them.
std::vector<Effect> same_motion_as(std::span<const double> values) {
  Effect friction(coulomb_friction);
  const double friction_nm = (values[0] + values[1]) / 2;
  const double most_nm = std::max(values[0], values[1]);
  friction.values = {friction_nm, most_nm > 0 ? values[2] * friction_nm / most_nm : values[2]};
  Effect bias(torque_bias);
  bias.values = {(values[0] - values[1]) / 2};
  return {friction, bias};
}

std::optional<std::vector<double>> values_of_same_motion(std::span<const Effect> others) {
  const double friction_nm = others[0].values[0];
  const double bias_nm = others[1].values[0];
  if (std::abs(bias_nm) > friction_nm) return std::nullopt;
  const double most_share = friction_nm > 0 ? 1 + std::abs(bias_nm) / friction_nm : 1;
  return std::vector{friction_nm + bias_nm, friction_nm - bias_nm, others[0].values[1] * most_share};
}

}  // namespace

constinit const EffectType asymmetric_friction{
    .id = "asymmetric_friction",
    .says = "dry friction that differs between the two directions",
    .parameters = kParameters,
    .in_plant = dry_friction<AsymmetricFriction>,
    .same_motion_as = same_motion_as,
    .values_of_same_motion = values_of_same_motion,
};

}  // namespace steerid::effect
