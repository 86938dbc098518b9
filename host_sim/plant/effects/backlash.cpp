// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Free play between hand and wheel, g to either side. Two laws of what the gap leaves:
//
//   contact_shape 0
//                   a dead zone: the arm's stiffness and damping act outside a gap around the centre, C (th - g) above
//                   it and C (th + g) below it. Inside, the wheel's own damping is all there is. The arm has no motion
//                   of its own, and its damper pulls as well as it pushes.
//   contact_shape 1
//                   a contact: the arm is a body of its own at the angle a, with the rest of J and B and with all of C,
//                   and is only pushed:
//                     apart, |th - a| < g     Jw th'' + Bw th' = T,   Ja a'' + Ba a' + C a = 0
//                     touching, a = th -+ g   J th'' + B th' + C a = T,   as long as the wheel pushes: Ja th'' + Ba th'
//                                             + C a does not change its sign
//                   They meet without a rebound: both go on at (Jw th' + Ja a')/J.
//
// Signature: no restoring torque near the centre; a small movement looks limp, a large one has its full stiffness.
// Sources: G. Tao and P. Kokotovic, Adaptive Control of Systems with Actuator and Sensor Nonlinearities (1996), dead
// zone; M. Nordin and P.-O. Gutman, Controlling mechanical systems with backlash, Automatica 38 (2002), section 3, for
// contacts that only push.
#include <algorithm>
#include <limits>
#include <memory>

#include "plant/effects/vocabulary.hpp"
#include "plant/effects/wheel_shares.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"half_gap_rad", 0.01, 0.0, 0.5, 0.002, "free play to either side"},
    kWheelDampingShare,
    // Any: of a rim that is held it is a third, of a column whose arm is a load on a shaft nearly all.
    Parameter{"wheel_inertia_share",
              0.3,
              0.05,
              0.98,
              0.05,
              "of a contact: part of J that is the wheel's own",
              {.mean = 0.5, .sd = 0.3}},
    Parameter{"contact_shape", 0, 0, 1, 1, "0 a dead zone, 1 an arm of its own that is only pushed", {}, true},
};

enum Region : int { kBelow, kApart, kAbove };

/// Where an arm at rest is, seen from the wheel.
Region region_of(double angle_rad, double half_gap_rad) {
  return angle_rad > half_gap_rad ? kAbove : angle_rad < -half_gap_rad ? kBelow : kApart;
}

class DeadZone final : public PlantEffect {
 public:
  explicit DeadZone(std::span<const double> values) : half_gap_rad_(values[0]), wheel_share_(values[1]) {}

  [[nodiscard]] PlantTraits traits() const override { return {.divided = true}; }
  [[nodiscard]] int first_region(const Instant& now) const override { return region_of(now.angle_rad, half_gap_rad_); }
  [[nodiscard]] double left_in_region(const Instant& now, const double*, const Balance&, double,
                                      int way) const override {
    if (now.region == kApart) return half_gap_rad_ - way * now.angle_rad;
    const int side = now.region - kApart;
    return way == side ? std::numeric_limits<double>::infinity() : side * now.angle_rad - half_gap_rad_;
  }
  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    if (now.region == kApart) {
      balance.stiffness_nm_per_rad = 0;
      balance.damping_nms_per_rad *= wheel_share_;
    } else {
      balance.spring_angle_rad -= (now.region - kApart) * half_gap_rad_;
    }
  }

 private:
  double half_gap_rad_;
  double wheel_share_;
};

/// Its own states are the arm's angle and rate while they are apart. While they touch, the first one is how far the arm
/// is behind the wheel, +-g.
class Contact final : public PlantEffect {
 public:
  explicit Contact(std::span<const double> values)
      : half_gap_rad_(values[0]), damping_share_(values[1]), inertia_share_(values[2]) {}

  [[nodiscard]] PlantTraits traits() const override {
    return {.states = 2,
            .divides_arm = true,
            .divided = true,
            .least_inertia_share = std::min(inertia_share_, 1 - inertia_share_)};
  }
  [[nodiscard]] int first_region(const Instant& now) const override { return region_of(now.angle_rad, half_gap_rad_); }
  /// An arm that nothing has touched for long rests at zero.
  void start(const Instant& now, double* own) override {
    own[0] = (now.region - kApart) * half_gap_rad_;
    own[1] = 0;
  }
  [[nodiscard]] double left_in_region(const Instant& now, const double* own, const Balance& balance,
                                      double acceleration_rad_s2, int way) const override {
    if (now.region == kApart) return half_gap_rad_ - way * (now.angle_rad - own[0]);
    const int side = now.region - kApart;
    if (way == side) return std::numeric_limits<double>::infinity();
    return side * ((1 - inertia_share_) * balance.inertia_kgm2 * acceleration_rad_s2 +
                   (1 - damping_share_) * balance.damping_nms_per_rad * now.rate_rad_s +
                   balance.stiffness_nm_per_rad * balance.spring_angle_rad);
  }
  [[nodiscard]] double enter_region(const Instant& now, double* own) const override {
    if (now.region == kApart) {
      own[0] = now.angle_rad - own[0];
      own[1] = now.rate_rad_s;
      return now.rate_rad_s;
    }
    const double together_rad_s = inertia_share_ * now.rate_rad_s + (1 - inertia_share_) * own[1];
    own[0] = (now.region - kApart) * half_gap_rad_;
    own[1] = 0;
    return together_rad_s;
  }
  void act(const Instant& now, const double* own, double* own_rate, Balance& balance) const override {
    own_rate[0] = 0;
    own_rate[1] = 0;
    if (now.region != kApart) {
      balance.spring_angle_rad -= own[0];
      return;
    }
    const double wheel_inertia = inertia_share_ * balance.inertia_kgm2;
    const double wheel_damping = damping_share_ * balance.damping_nms_per_rad;
    own_rate[0] = own[1];
    own_rate[1] = -((balance.damping_nms_per_rad - wheel_damping) * own[1] + balance.stiffness_nm_per_rad * own[0]) /
                  (balance.inertia_kgm2 - wheel_inertia);
    balance.inertia_kgm2 = wheel_inertia;
    balance.damping_nms_per_rad = wheel_damping;
    balance.stiffness_nm_per_rad = 0;
  }

 private:
  double half_gap_rad_;
  double damping_share_;
  double inertia_share_;
};

std::unique_ptr<PlantEffect> make(std::span<const double> values, std::span<const double>, const RunSetting&) {
  if (values[3] > 0) return std::make_unique<Contact>(values);
  return std::make_unique<DeadZone>(values);
}

}  // namespace

constinit const EffectType backlash{
    .id = "backlash",
    .says = "free play between hand and wheel around the centre",
    .parameters = kParameters,
    .in_plant = make,
    .joint = EffectType::Joint::kShares,
};

}  // namespace steerid::effect
