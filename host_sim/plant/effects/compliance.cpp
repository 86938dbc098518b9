// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Wheel and arm are two masses joined by a spring, where the hand grips. Both torques act on the wheel; stiffness and
// the rest of the damping act on the arm:
//   Jw th'' + Bw th' + k (th - a) + b (th' - a') = T_driver - T_motor
//   Ja a''  + Ba a'  + C a = k (th - a) + b (th' - a'),      Jw + Ja = J, Bw + Ba = B
//
// Signature: a second resonance near sqrt(k/(Jw Ja/(Jw+Ja))), above the drive's band but with a foot in it; the
// stiffness seen at low frequency is C k/(C + k). The wheel's part is stated as a share, so that both masses stay
// positive. Source: two-inertia model, e.g. Pick and Cole, Neuromuscular dynamics in the driver-vehicle system, VSD 44
// (2006).
#include <cmath>

#include "plant/effects/vocabulary.hpp"
#include "plant/effects/wheel_shares.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"grip_stiffness_nm_per_rad", 200.0, 2.0, 5000.0, 20.0, "k"},
    Parameter{"grip_damping_nms_per_rad", 0.4, 0.0, 10.0, 0.1, "b", {.mean = 0.4, .sd = 0.5}},
    wheel_inertia_share(0.95),
    kWheelDampingShare,
};

class Compliance final : public PlantEffect {
 public:
  Compliance(std::span<const double> values, const WheelArm& whole)
      : grip_stiffness_(values[0]),
        grip_damping_(values[1]),
        inertia_share_(values[2]),
        damping_share_(values[3]),
        whole_(whole) {}

  [[nodiscard]] PlantTraits traits() const override {
    return {.states = 2,
            .linear = true,
            .divides_arm = true,
            .added_stiffness_nm_per_rad = grip_stiffness_,
            .added_damping_nms_per_rad = grip_damping_,
            .least_inertia_share = std::min(inertia_share_, 1 - inertia_share_)};
  }

  /// The arm starts where the compliance's spring carries the arm's: at the ratio of the two stiffnesses, moving alike.
  void start(const Instant& now, double* own) override {
    const double ratio = grip_stiffness_ / (grip_stiffness_ + whole_.stiffness_nm_per_rad);
    own[0] = ratio * now.angle_rad;
    own[1] = ratio * now.rate_rad_s;
  }

  void act(const Instant& now, const double* own, double* own_rate, Balance& balance) const override {
    const double grip_nm = grip_stiffness_ * (now.angle_rad - own[0]) + grip_damping_ * (now.rate_rad_s - own[1]);
    const double wheel_inertia = inertia_share_ * balance.inertia_kgm2;
    const double wheel_damping = damping_share_ * balance.damping_nms_per_rad;
    own_rate[0] = own[1];
    own_rate[1] =
        (grip_nm - (balance.damping_nms_per_rad - wheel_damping) * own[1] - balance.stiffness_nm_per_rad * own[0]) /
        (balance.inertia_kgm2 - wheel_inertia);
    balance.inertia_kgm2 = wheel_inertia;
    balance.damping_nms_per_rad = wheel_damping;
    balance.stiffness_nm_per_rad = 0;
    balance.torque_nm -= grip_nm;
  }

 private:
  double grip_stiffness_;
  double grip_damping_;
  double inertia_share_;
  double damping_share_;
  WheelArm whole_;
};

std::unique_ptr<PlantEffect> make(std::span<const double> values, std::span<const double>, const RunSetting& setting) {
  return std::make_unique<Compliance>(values, setting.wheel);
}

}  // namespace

constinit const EffectType compliance{
    .id = "compliance",
    .says = "wheel and arm are two masses joined by a spring",
    .parameters = kParameters,
    .in_plant = make,
    .joint = EffectType::Joint::kAlone,
};

}  // namespace steerid::effect
