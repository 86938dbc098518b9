// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction that is the same both ways: Fc sgn(th'), and any torque up to Fc at rest.
//
// Signature: the free oscillation loses the same 4 Fc/C of amplitude every cycle; the wheel rests anywhere within
// +-Fc/C of its balance; in torque over rate a step of 2 Fc at rate zero. Steering columns have 0.1 to 1 Nm of it.
// Source: C. A. Coulomb 1785; Armstrong-Helouvry et al., A survey of models ... with friction, Automatica 30 (1994).
#include "plant/effects/dry_friction.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"friction_nm", 0.5, 0.0, 50.0, 0.05, "dry friction Fc"},
    kBristle,
};

class CoulombFriction final : public DryFriction {
 public:
  CoulombFriction(std::span<const double> values, const RunSetting& setting)
      : DryFriction(values[0], values[1], setting), friction_nm_(values[0]) {}
  [[nodiscard]] double dry_friction_nm(int, double) const override { return friction_nm_; }

 private:
  double friction_nm_;
};

}  // namespace

constinit const EffectType coulomb_friction{
    .id = "coulomb_friction",
    .says = "dry friction, the same both ways",
    .parameters = kParameters,
    .in_plant = dry_friction<CoulombFriction>,
};

}  // namespace steerid::effect
