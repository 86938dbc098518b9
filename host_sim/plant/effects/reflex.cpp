// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A stretch reflex: a restoring torque that follows the angle late, K y with q T^2 y'' + T y' + y = th(t - d).
//
// q is the shape of the muscle's low pass: 0 is one lag, 1/4 two equal ones (critically damped), 1/2 Butterworth's; in
// general 1/(4 zeta^2). Muscles are of second order, some 2 to 4 Hz, zeta 0.7 to 1 (Schouten, de Vlugt, van der Helm,
// IEEE Trans. Biomed. Eng. 55, 2008).
//
// Signature: stiffness at low frequency; around 1/(4 d) Hz it turns into negative damping and sharpens the resonance.
// Delays are 40 to 70 ms, each lag of the muscle's low pass 20 to 50 ms. What was before the start of a run is unknown;
// the angle is taken to have been where it starts. Source: Mirbagheri, Barbeau and Kearney, Exp. Brain Res. 135 (2000),
// parallel-cascade model of the joint's stiffness.
#include <algorithm>
#include <cmath>
#include <limits>

#include "plant/cubic.hpp"
#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"reflex_stiffness_nm_per_rad", 5.0, 0.0, 60.0, 0.5, "K"},
    // Twice as late it fits nearly as well, and is no stretch reflex any more.
    Parameter{
        "delay_s", 0.05, 0.02, 0.15, 0.005, "d, from stretch to torque", {.mean = 0.055, .sd = 0.02, .high = 0.09}},
    Parameter{"time_constant_s", 0.03, 0.005, 0.2, 0.005, "T, the muscle's low pass", {.mean = 0.05, .sd = 0.03}},
    Parameter{"low_pass_shape", 0.0, 0.0, 0.6, 0.05, "q: 0 one lag, 1/4 two equal ones", {.mean = 0.25, .sd = 0.15}},
};

class Reflex final : public PlantEffect {
 public:
  explicit Reflex(std::span<const double> values)
      : stiffness_(values[0]), delay_s_(values[1]), time_constant_s_(values[2]), shape_(values[3]) {
    // A second lag that is far shorter than the first is a delay: no step has to follow it.
    constexpr double kOneLag = 0.02;
    if (shape_ < kOneLag) {
      delay_s_ += shape_ * time_constant_s_;
      time_constant_s_ -= shape_ * time_constant_s_;
      shape_ = 0;
    }
  }

  [[nodiscard]] PlantTraits traits() const override {
    // The step stays well below the delay, so that the delayed angle always lies in the memory.
    return {.states = 2,
            .remembers = true,
            .added_stiffness_nm_per_rad = stiffness_,
            .fastest_per_s = std::max(fastest_pole_per_s(), 1 / delay_s_)};
  }

  void start(const Instant& now, double* own) override {
    own[0] = now.angle_rad;
    own[1] = 0;
    before_rad_ = now.angle_rad;
    count_ = 0;
    cursor_ = 0;
    between_ = kNever;
    remember(now);
  }

  void act(const Instant& now, const double* own, double* own_rate, Balance& balance) const override {
    const double rise = delayed(now.time_s - delay_s_) - own[0];
    if (shape_ > 0) {
      own_rate[0] = own[1];
      own_rate[1] = (rise / time_constant_s_ - own[1]) / (shape_ * time_constant_s_);
    } else {
      own_rate[0] = rise / time_constant_s_;
      own_rate[1] = 0;
    }
    balance.torque_nm -= stiffness_ * own[0];
  }

  void remember(const Instant& now) override {
    // The newest node is replaced until it stands a sixty-fourth of the delay from the one before it: the memory then
    // spans the delay however small the steps are, and always ends at the present.
    const bool crowded = count_ >= 2 && now.time_s - node(count_ - 2).time_s < delay_s_ / 64;
    if (!crowded) ++count_;
    nodes_[(count_ - 1) % kNodes] = {now.time_s, now.angle_rad, now.rate_rad_s};
  }

 private:
  [[nodiscard]] double fastest_pole_per_s() const {
    if (shape_ == 0) return 1 / time_constant_s_;
    return (1 + std::sqrt(std::max(0.0, 1 - 4 * shape_))) / (2 * shape_ * time_constant_s_);
  }

  struct Node {
    double time_s = 0, angle_rad = 0, rate_rad_s = 0;
  };
  static constexpr std::size_t kNodes = 256;
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] const Node& node(std::size_t index) const { return nodes_[index % kNodes]; }

  [[nodiscard]] double delayed(double at_s) const {
    const std::size_t oldest = count_ > kNodes ? count_ - kNodes : 0;
    if (at_s <= node(oldest).time_s) return count_ > kNodes ? node(oldest).angle_rad : before_rad_;
    if (count_ < 2) return node(oldest).angle_rad;
    // The instants of a step lie close together and move on slowly: look where the last one was found.
    std::size_t k = std::max(cursor_, oldest);
    while (k + 2 < count_ && node(k + 1).time_s <= at_s) ++k;
    while (k > oldest && node(k).time_s > at_s) --k;
    cursor_ = k;
    const Node& a = node(k);
    if (k != between_ || k + 2 == count_) {  // the newest node may have been replaced
      const Node& b = node(k + 1);
      angle_ = Cubic::hermite(a.angle_rad, a.rate_rad_s, b.angle_rad, b.rate_rad_s, b.time_s - a.time_s);
      between_ = k;
    }
    return angle_.at(at_s - a.time_s);
  }

  double stiffness_;
  double delay_s_;
  double time_constant_s_;
  double shape_;
  double before_rad_ = 0;
  std::array<Node, kNodes> nodes_{};
  std::size_t count_ = 0;  // of all nodes since the start
  // Where the last look-up ended, and the angle there; a memory of the search, not of the plant.
  mutable std::size_t cursor_ = 0;
  mutable std::size_t between_ = kNever;
  mutable Cubic angle_{};
};

}  // namespace

constinit const EffectType reflex{
    .id = "reflex",
    .says = "a delayed, low-passed restoring torque: the stretch reflex",
    .parameters = kParameters,
    .in_plant = plant_effect<Reflex>,
};

}  // namespace steerid::effect
