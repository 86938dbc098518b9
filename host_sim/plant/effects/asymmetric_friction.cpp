// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction that differs between the two directions: Fp for th' > 0, -Fm for th' < 0, anything between at rest.
//
// It is (Fp + Fm)/2 in both directions beside a torque offset of (Fp - Fm)/2, moving and at rest, where either lets the
// torque be anything from -Fm to Fp: no drive tells the two apart. Source: as coulomb_friction; asymmetry is usual with
// preloaded gears.
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

std::vector<Effect> same_motion_as(std::span<const double> values) {
  Effect friction(coulomb_friction);
  friction.values = {(values[0] + values[1]) / 2, values[2]};
  Effect bias(torque_bias);
  bias.values = {(values[0] - values[1]) / 2};
  return {friction, bias};
}

}  // namespace

constinit const EffectType asymmetric_friction{
    .id = "asymmetric_friction",
    .says = "dry friction that differs between the two directions",
    .parameters = kParameters,
    .in_plant = dry_friction<AsymmetricFriction>,
    .same_motion_as = same_motion_as,
};

}  // namespace steerid::effect
