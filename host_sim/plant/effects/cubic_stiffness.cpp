// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Hardening (C3 > 0) or softening (C3 < 0): the torque C3 th^3 beside C th.
//
// Signature: the natural frequency moves with amplitude; a third harmonic. With C3 < 0 the wheel has no balance beyond
// th = sqrt(C/-C3), and a free run driven past it diverges.
// Source: G. Duffing 1918.
#include <cmath>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"cubic_stiffness_nm_per_rad3", 10.0, -5000.0, 5000.0, 1.0, "C3"},
};

class CubicStiffness final : public PlantEffect {
 public:
  explicit CubicStiffness(std::span<const double> values) : cubic_(values[0]) {}

  [[nodiscard]] PlantTraits traits() const override {
    // 3 |C3| th^2 over the angles of a drive: a strong one is felt at 0.1 rad, a weak one only at 1 rad.
    return {.added_stiffness_nm_per_rad = std::min(3 * std::abs(cubic_), kFeltNmPerRad)};
  }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    balance.torque_nm -= cubic_ * now.angle_rad * now.angle_rad * now.angle_rad;
  }

 private:
  static constexpr double kFeltNmPerRad = 150;
  double cubic_;
};

}  // namespace

constinit const EffectType cubic_stiffness{
    .id = "cubic_stiffness",
    .says = "a stiffness that hardens or softens with angle",
    .parameters = kParameters,
    .in_plant = plant_effect<CubicStiffness>,
};

}  // namespace steerid::effect
