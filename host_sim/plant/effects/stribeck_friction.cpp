// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction that is larger at breakaway and falls with speed: F(v) = Fc + (Fs - Fc) exp(-(v/vs)^2).
//
// Signature: like Coulomb friction, and stick-slip in slow movement, where the falling branch feeds the oscillation.
// The breakaway level is stated as a ratio, so that Fs >= Fc holds whatever a fit tries.
// Source: R. Stribeck 1902; the Gaussian form is Bo and Pavelescu, Wear 82 (1982).
#include <cmath>

#include "plant/effects/dry_friction.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"friction_nm", 0.4, 0.0, 50.0, 0.05, "dry friction Fc at speed"},
    Parameter{
        "breakaway_ratio", 1.8, 1.0, 4.0, 0.1, "at breakaway over that at speed, Fs/Fc", {.mean = 1.8, .sd = 0.45}},
    Parameter{"stribeck_rate_rad_s", 0.25, 0.02, 5.0, 0.05, "speed vs over which it falls", {.mean = 0.28, .sd = 0.12}},
    kBristle,
};

class StribeckFriction final : public DryFriction {
 public:
  /// The steepest slope of the Gaussian is sqrt(2/e) = 0.86 of its height over its width.
  StribeckFriction(std::span<const double> values, const RunSetting& setting)
      : DryFriction(values[0] * values[1], values[3], setting, 0.86 * values[0] * (values[1] - 1) / values[2]),
        friction_nm_(values[0]),
        excess_nm_(values[0] * (values[1] - 1)),
        rate_rad_s_(values[2]) {}

  [[nodiscard]] double dry_friction_nm(int, double speed_rad_s) const override {
    const double ratio = speed_rad_s / rate_rad_s_;
    return friction_nm_ + excess_nm_ * std::exp(-ratio * ratio);
  }

 private:
  double friction_nm_;
  double excess_nm_;
  double rate_rad_s_;
};

}  // namespace

constinit const EffectType stribeck_friction{
    .id = "stribeck_friction",
    .says = "dry friction that is larger at breakaway and falls with speed",
    .parameters = kParameters,
    .in_plant = dry_friction<StribeckFriction>,
};

}  // namespace steerid::effect
