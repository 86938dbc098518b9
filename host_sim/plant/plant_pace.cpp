// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How long a step of the plant may be: what wheel and effects are capable of, and what of it takes part at present.
#include <algorithm>
#include <cmath>

#include "plant/plant.hpp"

namespace steerid {
namespace {

// How much longer a step may be while nothing takes part in passing. What begins to do so within it, a loop that opens
// again, is still integrated stably then (step * rate < 2.8).
constexpr double kMostEase = 8;

constexpr double kFast_rad_s = 1.5;  // 60 degrees at 0.25 Hz reach 1.6

/// The rate that steps have to resolve. What is faster than torques and hands move it follows them closely, and shows
/// its own swing after a kink only, small.
double stepped_per_s(double fastest_per_s) {
  constexpr double kFollows_per_s = 120;
  return fastest_per_s < kFollows_per_s ? fastest_per_s : std::sqrt(kFollows_per_s * fastest_per_s);
}

}  // namespace

void Plant::set_pace() {
  double stiffness = std::abs(wheel_.stiffness_nm_per_rad);
  double damping = std::abs(wheel_.damping_nms_per_rad);
  double passing_stiffness = 0;
  bent_stiffness_nm_per_rad_ = wheel_.stiffness_nm_per_rad;
  double inertia = wheel_.inertia_kgm2;
  double effects_per_s = 0;
  double passing_per_s = 0;
  double feeding = 0;
  double damping_per_rate = 0;
  for (const Part& part : parts_) {
    const PlantTraits& traits = part.traits;
    stiffness += traits.added_stiffness_nm_per_rad;
    damping += traits.added_damping_nms_per_rad;
    damping_per_rate += traits.damping_per_rate_nms2_per_rad2;
    passing_stiffness += traits.passing_stiffness_nm_per_rad;
    bent_stiffness_nm_per_rad_ += traits.bending_stiffness_nm_per_rad;
    inertia = std::min(inertia, traits.least_inertia_share * wheel_.inertia_kgm2);
    effects_per_s = std::max(effects_per_s, traits.fastest_per_s);
    passing_per_s = std::max(passing_per_s, traits.passing_per_s);
    fastest_per_rad_ = std::max(fastest_per_rad_, traits.fastest_per_rad);
    feeding += traits.in_time_only ? 0 : 1;
    varies_ = varies_ || traits.takes_part_in_passing();
  }
  const double crowd = std::sqrt(std::max(feeding, 1.0));  // several effects add their errors and feed each other
  const double engaged_per_s = std::max(effects_per_s, passing_per_s);
  swing_per_s_ = crowd * std::max(engaged_per_s, std::sqrt((stiffness + passing_stiffness) / inertia));
  damped_per_s_ = crowd * damping / inertia;
  damped_per_rad_ = crowd * damping_per_rate / inertia;
  damping += damping_per_rate * kFast_rad_s;
  const auto with = [&](double own_per_s, double stiffness_nm_per_rad, double damping_nms_per_rad) {
    return crowd * std::max({own_per_s, std::sqrt(stiffness_nm_per_rad / inertia), damping_nms_per_rad / inertia});
  };
  constexpr double kOverdamped = 3;  // a mode that damping alone makes fast follows the others
  fastest_per_s_ = with(engaged_per_s, stiffness + passing_stiffness, damping);
  const double stable_per_s = fastest_per_s_ / kMostEase;
  engaged_per_s_ =
      std::max(stepped_per_s(with(engaged_per_s, stiffness + passing_stiffness, damping / kOverdamped)), stable_per_s);
  apart_per_s_ = std::max(stepped_per_s(with(effects_per_s, stiffness, damping / kOverdamped)), stable_per_s);
  constexpr double kSummed = 2;  // what varies over the angle is a sum more than a motion
  fastest_per_rad_ *= crowd / kSummed;
}

double Plant::present_per_s() const {
  constexpr double kChange_rad_s = 0.1;  // within a step
  constexpr double kMost_rad_s = 20;     // beyond it no hand turns a wheel
  const double rate_rad_s = std::min(std::abs(state_[1]) + kChange_rad_s, kMost_rad_s);
  const bool engaged = std::ranges::any_of(parts_, [&](const Part& part) {
    return part.traits.takes_part_in_passing() &&
           part.effect->engaged(instant(time_s_, state_, part), &state_[part.first_state]);
  });
  const double over_angle_per_s = fastest_per_rad_ * rate_rad_s;
  return engaged ? std::max(engaged_per_s_, over_angle_per_s) : std::max(apart_per_s_, over_angle_per_s / kMostEase);
}

double Plant::fastest_per_s(double rate_rad_s) const {
  constexpr double kBrisk_rad_s = 0.5;
  if (linear_plant_ && !bends_) return 0;
  const double damped_per_s = damped_per_s_ + damped_per_rad_ * std::min(rate_rad_s, kFast_rad_s);
  return std::max({swing_per_s_, damped_per_s, fastest_per_rad_ * kBrisk_rad_s});
}

double Plant::most_steps_per_s() const {
  if (linear_plant_ && !bends_) return 0;
  return std::max(engaged_per_s_ / kStepAngle, bends_ ? fastest_per_s_ : 0);
}

/// Exact ones, as many in each third of a piece, and so short that the wheel does not swing to and fro within one.
int Plant::steps_while_bending(double span_s) const {
  constexpr double kSwing = 1;  // rad
  return kThirds * static_cast<int>(std::ceil(std::max(span_s * fastest_per_s_ / (kThirds * kSwing), 1.0)));
}

int Plant::steps(double span_s, double fastest_per_s) const {
  constexpr double kMost = 1e5;
  return static_cast<int>(std::clamp(std::ceil(span_s * fastest_per_s / kStepAngle), 1.0, kMost));
}

}  // namespace steerid
