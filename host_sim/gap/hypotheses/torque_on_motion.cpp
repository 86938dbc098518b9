// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/hypotheses/torque_on_motion.hpp"

#include <Eigen/Core>
#include <array>
#include <map>

#include "plant/linear_response.hpp"

namespace steerid::gap {
namespace {

/// What is beside the linear wheel's own side and the applied torque of a balance at one instant, Nm.
double added_nm(const Balance& now, const WheelArm& wheel, double net_torque_nm, double angle_rad, double rate_rad_s,
                double acceleration_rad_s2) {
  return now.torque_nm + (now.torque_driver_nm - now.torque_motor_nm - net_torque_nm) -
         (now.inertia_kgm2 - wheel.inertia_kgm2) * acceleration_rad_s2 -
         (now.damping_nms_per_rad - wheel.damping_nms_per_rad) * rate_rad_s -
         (now.stiffness_nm_per_rad * now.spring_angle_rad - wheel.stiffness_nm_per_rad * angle_rad);
}

/// Of the linear wheel without torques.
Balance balance_of(const WheelArm& wheel, double angle_rad) {
  return {.inertia_kgm2 = wheel.inertia_kgm2,
          .damping_nms_per_rad = wheel.damping_nms_per_rad,
          .stiffness_nm_per_rad = wheel.stiffness_nm_per_rad,
          .spring_angle_rad = angle_rad,
          .torque_driver_nm = 0,
          .torque_motor_nm = 0,
          .torque_nm = 0};
}

/// The regions and own states of what is divided.
class Divided {
 public:
  Divided(PlantEffect& effect, const WheelArm& wheel, double period_s)
      : effect_(effect), wheel_(wheel), period_s_(period_s), states_(effect.traits().states) {}

  void start(Instant& now) {
    now.region = region_ = effect_.first_region(now);
    effect_.start(now, own_.data());
  }
  /// Goes on to the next sample; returns by how much the wheel's rate jumps there.
  double go_on(Instant& now, double acceleration_rad_s2) {
    now.region = region_;
    if (states_ == 0) {
      now.region = region_ = effect_.first_region(now);
      return 0;
    }
    own_ = transition(now) * own_;
    Balance balance = balance_of(wheel_, now.angle_rad);
    Eigen::Vector4d own_rate;
    effect_.act(now, own_.data(), own_rate.data(), balance);
    double jump_rad_s = 0;
    for (const int way : {-1, 1}) {
      if (effect_.left_in_region(now, own_.data(), balance, acceleration_rad_s2, way) >= 0) continue;
      now.region = region_ += way;
      jump_rad_s = effect_.enter_region(now, own_.data()) - now.rate_rad_s;
      break;
    }
    return jump_rad_s;
  }
  [[nodiscard]] const double* own() const { return own_.data(); }

 private:
  /// Of the own states over a sample, in the present region.
  const Eigen::Matrix4d& transition(const Instant& now) {
    const auto found = transitions_.find(region_);
    if (found != transitions_.end()) return found->second;
    Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
    for (int i = 0; i < states_; ++i) {
      const Eigen::Vector4d unit = Eigen::Vector4d::Unit(i);
      Eigen::Vector4d slope = Eigen::Vector4d::Zero();
      Balance balance = balance_of(wheel_, 0);
      effect_.act(now, unit.data(), slope.data(), balance);
      rate.col(i) = slope;
    }
    return transitions_.emplace(region_, LinearStep(rate, Eigen::Vector4d::Zero(), period_s_).transition).first->second;
  }

  PlantEffect& effect_;
  const WheelArm& wheel_;
  double period_s_;
  int states_;
  int region_ = 0;
  Eigen::Vector4d own_ = Eigen::Vector4d::Zero();
  std::map<int, Eigen::Matrix4d> transitions_;
};

}  // namespace

void torque_on_motion(PlantEffect& effect, const WheelArm& wheel, const Record& record, const MeasuredMotion& motion,
                      std::vector<double>& torque_nm) {
  const double period_s = motion.time_s.size() > 1 ? motion.time_s[1] - motion.time_s[0] : 1;
  Divided divided(effect, wheel, period_s);
  std::array<double, 4> own_rate{};
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double angle_rad = motion.angle_rad[i];
    const double rate_rad_s = motion.rate_rad_s[i];
    const double acceleration_rad_s2 = motion.acceleration_rad_s2[i];
    Instant now{.time_s = motion.time_s[i],
                .angle_rad = angle_rad,
                .rate_rad_s = rate_rad_s,
                .step_middle_s = motion.time_s[i],
                .direction = rate_rad_s < 0 ? -1 : 1,
                .region = 0,
                .slips = 0};
    if (i == 0) divided.start(now);
    const double jump_rad_s = divided.go_on(now, acceleration_rad_s2);
    Balance balance = balance_of(wheel, angle_rad);
    balance.torque_driver_nm = record.torque_driver_nm[i];
    balance.torque_motor_nm = record.torque_motor_nm[i];
    balance.torque_nm = wheel.inertia_kgm2 * jump_rad_s / period_s;
    effect.act(now, divided.own(), own_rate.data(), balance);
    torque_nm[i] = added_nm(balance, wheel, record.net_torque_nm(i), angle_rad, rate_rad_s, acceleration_rad_s2);
  }
}

}  // namespace steerid::gap
