// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The hand leaves the wheel for a while: its stiffness, damping, inertia and torque go with it, and come back.
//
// The hand is away during [first + i period, first + i period + away) for every whole i, also before the origin. The
// wheel keeps its angle and rate across both ends; with the hand away only its own inertia and damping are left and it
// drifts under the motor's torque.
// Signature: the model fails in windows and is right between them; inside, the angle runs away.
#include <cmath>

#include "plant/effects/vocabulary.hpp"
#include "plant/effects/wheel_shares.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    // A hand that was seen to leave once leaves no more, as far as is known; within a record it is worth half a nat.
    Parameter{"period_s", 20.0, 0.5, 1e4, 0.5, "from one leave to the next", {.mean = 5e3, .sd = 5e3}},
    Parameter{"away_s", 0.3, 0.0, 1e3, 0.05, "how long the hand stays away, at most a period"},
    Parameter{"first_s", 5.0, -1e4, 1e5, 0.5, "when it leaves"},
    wheel_inertia_share(1.0),
    kWheelDampingShare,
};

class HandsOff final : public PlantEffect {
 public:
  HandsOff(std::span<const double> values, const WheelArm& wheel)
      : wheel_(wheel),
        period_s_(values[0]),
        away_s_(std::min(values[1], values[0])),
        first_s_(values[2]),
        inertia_share_(values[3]),
        damping_share_(values[4]) {}

  [[nodiscard]] PlantTraits traits() const override {
    const double alone_per_s = damping_share_ * wheel_.damping_nms_per_rad / (inertia_share_ * wheel_.inertia_kgm2);
    return {.fastest_per_s = alone_per_s};
  }

  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    if (since_leaving(now.step_middle_s) >= away_s_) return;
    balance.stiffness_nm_per_rad = 0;
    balance.damping_nms_per_rad *= damping_share_;
    balance.inertia_kgm2 *= inertia_share_;
    balance.torque_driver_nm = 0;
  }

  [[nodiscard]] double next_jump_s(double time_s) const override {
    const double turn = std::floor((time_s - first_s_) / period_s_);
    for (double i = turn; i <= turn + 1; i += 1) {
      const double leave = first_s_ + i * period_s_;
      if (leave > time_s) return leave;
      if (leave + away_s_ > time_s) return leave + away_s_;
    }
    return first_s_ + (turn + 2) * period_s_;
  }

 private:
  [[nodiscard]] double since_leaving(double time_s) const {
    const double turns = (time_s - first_s_) / period_s_;
    return (turns - std::floor(turns)) * period_s_;
  }

  WheelArm wheel_;
  double period_s_;
  double away_s_;
  double first_s_;
  double inertia_share_;
  double damping_share_;
};

std::unique_ptr<PlantEffect> make(std::span<const double> values, std::span<const double>, const RunSetting& setting) {
  return std::make_unique<HandsOff>(values, setting.wheel);
}

}  // namespace

constinit const EffectType hands_off{
    .id = "hands_off",
    .says = "the hand leaves the wheel for a while and comes back",
    .parameters = kParameters,
    .in_plant = make,
    .joint = EffectType::Joint::kShares,
};

}  // namespace steerid::effect
