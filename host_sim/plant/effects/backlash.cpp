// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Free play between hand and wheel: the arm's stiffness and damping act only outside a gap around the centre,
// C (th - g) above it and C (th + g) below it. Inside, the wheel's own damping is all there is.
//
// Signature: no restoring torque near the centre; a small movement looks limp, a large one has its full stiffness.
// Source: G. Tao and P. Kokotovic, Adaptive Control of Systems with Actuator and Sensor Nonlinearities (1996), dead
// zone.
#include "plant/effects/vocabulary.hpp"
#include "plant/effects/wheel_shares.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"half_gap_rad", 0.01, 0.0, 0.5, 0.002, "free play to either side"},
    kWheelDampingShare,
};

class Backlash final : public PlantEffect {
 public:
  explicit Backlash(std::span<const double> values) : half_gap_rad_(values[0]), wheel_share_(values[1]) {}

  [[nodiscard]] PlantTraits traits() const override {
    return {.edges_rad = {-half_gap_rad_, half_gap_rad_}, .edge_count = 2};
  }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    if (now.region == kInside) {
      balance.stiffness_nm_per_rad = 0;
      balance.damping_nms_per_rad *= wheel_share_;
    } else {
      balance.spring_angle_rad -= now.region > kInside ? half_gap_rad_ : -half_gap_rad_;
    }
  }

 private:
  static constexpr int kInside = 1;
  double half_gap_rad_;
  double wheel_share_;
};

}  // namespace

constinit const EffectType backlash{
    .id = "backlash",
    .says = "free play between hand and wheel around the centre",
    .parameters = kParameters,
    .in_plant = plant_effect<Backlash>,
    .joint = EffectType::Joint::kShares,
};

}  // namespace steerid::effect
