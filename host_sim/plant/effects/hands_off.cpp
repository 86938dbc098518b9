// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The hand leaves the wheel for a while: its stiffness, damping, inertia and torque go with it, and come back.
//
// When it leaves and how it fades is hands_away.hpp's. The share of the hand that is away takes as much of C, of the
// arm's parts of J and B and of the driver's torque; the wheel's own inertia and damping are left and it drifts under
// the motor's torque. The torque sensor sees what the hand still applies, so that a record's torque, which is replayed,
// has gone with the hand already.
// Signature: the model fails in windows and is right between them; inside, the angle runs away.
#include "plant/effects/hands_away.hpp"
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
    Parameter{
        "fade_s", 0.0, 0.0, 0.3, 0.02, "time constant of its leaving and coming back", {.mean = 0.05, .sd = 0.05}},
};

class HandsOff final : public PlantEffect {
 public:
  HandsOff(std::span<const double> values, const RunSetting& setting)
      : wheel_(setting.wheel),
        torque_has_gone_(setting.replay),
        away_(values),
        inertia_share_(values[3]),
        damping_share_(values[4]) {}

  [[nodiscard]] PlantTraits traits() const override {
    const double alone_per_s = damping_share_ * wheel_.damping_nms_per_rad / (inertia_share_ * wheel_.inertia_kgm2);
    constexpr double kBeside = 2;  // a wheel that grows lighter as its hand fades is faster than the fade
    return {.fastest_per_s = alone_per_s, .passing_per_s = away_.fades() ? kBeside / away_.fade_s() : 0};
  }

  [[nodiscard]] bool engaged(const Instant& now, const double*) const override { return away_.fading(now.time_s); }

  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    const double away = away_.share(now.time_s, now.step_middle_s);
    if (away == 0) return;
    balance.stiffness_nm_per_rad *= 1 - away;
    balance.damping_nms_per_rad *= 1 - away * (1 - damping_share_);
    balance.inertia_kgm2 *= 1 - away * (1 - inertia_share_);
    if (!torque_has_gone_) balance.torque_driver_nm *= 1 - away;
  }

  [[nodiscard]] double next_jump_s(double time_s) const override { return away_.next_edge_s(time_s); }

 private:
  WheelArm wheel_;
  bool torque_has_gone_;
  HandsAway away_;
  double inertia_share_;
  double damping_share_;
};

/// What the torque sensor sees of the driver's torque.
class AppliedTorque final : public RecordEffect {
 public:
  explicit AppliedTorque(std::span<const double> values) : away_(values) {}
  void record(Channels& now) override { now.torque_driver_nm *= 1 - away_.share(now.time_s, now.time_s); }

 private:
  HandsAway away_;
};

std::unique_ptr<PlantEffect> make(std::span<const double> values, std::span<const double>, const RunSetting& setting) {
  return std::make_unique<HandsOff>(values, setting);
}

}  // namespace

constinit const EffectType hands_off{
    .id = "hands_off",
    .says = "the hand leaves the wheel for a while and comes back",
    .parameters = kParameters,
    .in_plant = make,
    .on_record = record_effect<AppliedTorque>,
    .joint = EffectType::Joint::kShares,
};

}  // namespace steerid::effect
