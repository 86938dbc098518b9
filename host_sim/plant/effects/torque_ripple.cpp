// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A torque periodic in the wheel angle: A sin(n th + phase), as motor cogging or a universal joint makes it.
//
// Signature: residual tied to the angle, not to time; at steady speed a tone of n th'/(2 pi) Hz.
// Source: cogging of permanent-magnet motors; n is slots and gear ratio times turns, or 2 for a single joint.
#include <cmath>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"ripple_nm", 0.3, 0.0, 20.0, 0.02, "amplitude A"},
    // One cycle a turn is a weight, which is another effect.
    Parameter{"cycles_per_turn", 12.0, 1.0, 200.0, 1.0, "n", {.low = 2}},
    Parameter{"phase_rad", 0.0, -6.3, 6.3, 0.2, "at angle zero"},
};

class TorqueRipple final : public PlantEffect {
 public:
  explicit TorqueRipple(std::span<const double> values)
      : ripple_nm_(values[0]), cycles_(values[1]), phase_(values[2]) {}

  [[nodiscard]] PlantTraits traits() const override {
    // Beside the ripple's own slope, the torque varies in time as fast as the wheel sweeps over the cycles.
    return {.added_stiffness_nm_per_rad = ripple_nm_ * cycles_, .fastest_per_rad = cycles_};
  }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    balance.torque_nm -= ripple_nm_ * std::sin(cycles_ * now.angle_rad + phase_);
  }

 private:
  double ripple_nm_;
  double cycles_;
  double phase_;
};

}  // namespace

constinit const EffectType torque_ripple{
    .id = "torque_ripple",
    .says = "a torque periodic in the wheel angle",
    .parameters = kParameters,
    .in_plant = plant_effect<TorqueRipple>,
};

}  // namespace steerid::effect
