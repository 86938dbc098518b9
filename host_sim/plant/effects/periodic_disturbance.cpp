// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An unmeasured sinusoidal torque, A sin(2 pi f t + phase): shimmy, the unbalance of a road wheel.
//
// Signature: a line in the residual's spectrum that is not in the torque's. t counts from the record's origin.
#include <cmath>
#include <numbers>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"amplitude_nm", 0.6, 0.0, 20.0, 0.05, "A"},
    Parameter{"frequency_hz", 3.5, 0.05, 25.0, 0.05, "f"},
    Parameter{"phase_rad", 0.0, -6.3, 6.3, 0.2, "at time zero"},
};

class PeriodicDisturbance final : public PlantEffect {
 public:
  explicit PeriodicDisturbance(std::span<const double> values)
      : amplitude_nm_(values[0]), rate_rad_s_(2 * std::numbers::pi * values[1]), phase_rad_(values[2]) {}
  [[nodiscard]] PlantTraits traits() const override { return {.in_time_only = true}; }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    balance.torque_nm += amplitude_nm_ * std::sin(rate_rad_s_ * now.time_s + phase_rad_);
  }

 private:
  double amplitude_nm_;
  double rate_rad_s_;
  double phase_rad_;
};

}  // namespace

constinit const EffectType periodic_disturbance{
    .id = "periodic_disturbance",
    .says = "an unmeasured sinusoidal torque",
    .parameters = kParameters,
    .in_plant = plant_effect<PeriodicDisturbance>,
};

}  // namespace steerid::effect
