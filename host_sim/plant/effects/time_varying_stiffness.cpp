// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The driver changes co-contraction within the record: C becomes C r(t), and B becomes B r(t)^damping_exponent.
//   shape 0, step    r = ratio from the time on
//   shape 1, ramp    r goes from 1 to ratio over the length
//   shape 2, swing   r = 1 + (ratio - 1) sin(2 pi (t - time)/length), all through the record
//
// Signature: the residual of the fixed C grows and changes sign with time, in phase with the angle.
// Source: Lv et al. 2018, section II: C follows co-contraction, from steering to bracing. Muscles stiffen and damp
// together: B follows the root of C in an arm of constant damping ratio, and C itself in limb models (Heitmann, Ferns,
// Breakspear 2011, doi:10.3389/fnbot.2011.00005); a spring that is exchanged on a bench leaves B as it is.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "plant/effects/vocabulary.hpp"

namespace steerid::effect {
namespace {

constexpr std::array kParameters = {
    Parameter{"shape", 0, 0, 2, 1, "0 step, 1 ramp, 2 swing", {}, true},
    Parameter{"stiffness_ratio", 1.4, 0.1, 5.0, 0.05, "C after the change over C before it"},
    Parameter{"time_s", 20.0, -1e4, 1e5, 1.0, "of the step, of the ramp's start, of a zero of the swing"},
    Parameter{"length_s", 10.0, 0.2, 1e4, 1.0, "of the ramp, or the swing's period"},
    Parameter{"damping_exponent", 0.0, 0.0, 1.0, 0.05, "B follows this power of C's ratio", {.mean = 0.5, .sd = 0.4}},
};

class TimeVaryingStiffness final : public PlantEffect {
 public:
  TimeVaryingStiffness(std::span<const double> values, const WheelArm& wheel)
      : stiffness_(wheel.stiffness_nm_per_rad),
        damping_(wheel.damping_nms_per_rad),
        shape_(static_cast<int>(values[0])),
        rise_(values[1] - 1),
        time_s_(values[2]),
        length_s_(values[3]),
        damping_exponent_(values[4]) {}

  [[nodiscard]] PlantTraits traits() const override {
    return {.added_stiffness_nm_per_rad = std::abs(rise_) * stiffness_,
            .added_damping_nms_per_rad = damping_ * (std::pow(1 + std::abs(rise_), damping_exponent_) - 1),
            .fastest_per_s = shape_ == kSwing ? 2 * std::numbers::pi / length_s_ : 0};
  }

  void act(const Instant& now, const double*, double*, Balance& balance) const override {
    const double ratio = 1 + rise_ * part(now);
    balance.stiffness_nm_per_rad *= ratio;
    if (damping_exponent_ > 0) balance.damping_nms_per_rad *= std::pow(std::max(ratio, 0.0), damping_exponent_);
  }

  [[nodiscard]] double next_jump_s(double time_s) const override {
    if (shape_ != kSwing && time_s < time_s_) return time_s_;
    if (shape_ == kRamp && time_s < time_s_ + length_s_) return time_s_ + length_s_;
    return kNever_s;
  }

 private:
  enum Shape : int { kStep = 0, kRamp = 1, kSwing = 2 };

  /// How much of the change has happened.
  [[nodiscard]] double part(const Instant& now) const {
    if (shape_ == kSwing) return swing_at(now.time_s);
    if (now.step_middle_s < time_s_) return 0;
    if (shape_ == kStep || now.step_middle_s > time_s_ + length_s_) return 1;
    return (now.time_s - time_s_) / length_s_;
  }

  /// Kept for the next question: the stages of a step ask for the same instants.
  [[nodiscard]] double swing_at(double time_s) const {
    if (time_s != swing_at_s_) {
      swing_at_s_ = time_s;
      swing_ = std::sin(2 * std::numbers::pi * (time_s - time_s_) / length_s_);
    }
    return swing_;
  }

  double stiffness_;
  double damping_;
  int shape_;
  double rise_;
  double time_s_;
  double length_s_;
  double damping_exponent_;
  mutable double swing_at_s_ = std::numeric_limits<double>::quiet_NaN();
  mutable double swing_ = 0;
};

std::unique_ptr<PlantEffect> make(std::span<const double> values, std::span<const double>, const RunSetting& setting) {
  return std::make_unique<TimeVaryingStiffness>(values, setting.wheel);
}

}  // namespace

constinit const EffectType time_varying_stiffness{
    .id = "time_varying_stiffness",
    .says = "the stiffness steps, ramps or swings within the record",
    .parameters = kParameters,
    .in_plant = make,
};

}  // namespace steerid::effect
