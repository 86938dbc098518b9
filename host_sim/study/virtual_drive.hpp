// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel and its driver for studies of behaviour over time: torques given tick by tick, an arm that may become another
// one at any tick, sensors with white noise. The wheel moves by the plant's exact step (checked against integrators of
// their own in tests/unit); the identifier's code has no part in it.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "app/task.hpp"
#include "experiment/signal_point.hpp"
#include "plant/linear_response.hpp"
#include "port/sample.hpp"
#include "sensors/random.hpp"

namespace steerid {

/// Standard deviation of each sensor's white noise; the defaults are those of a production wheel.
struct SensorDeviation {
  double angle_rad = 0.0007;
  double torque_driver_nm = 0.03;
  double torque_motor_nm = 0.009;

  [[nodiscard]] double torque_nm() const { return std::hypot(torque_driver_nm, torque_motor_nm); }
};

/// The torques at one tick, with the slopes that carry them to the next.
struct Torques {
  SignalPoint driver{};
  SignalPoint motor{};
  SignalPoint unmeasured{};
};

class VirtualWheel {
 public:
  VirtualWheel(const WheelArm& arm, std::uint64_t seed, const SensorDeviation& noise = {})
      : noise_(noise), angle_noise_(seed, 901), driver_noise_(seed, 902), motor_noise_(seed, 903) {
    become(arm);
  }

  /// From now on the arm is another one.
  void become(const WheelArm& arm) {
    arm_ = arm;
    step_.emplace(arm, kTickS);
  }
  [[nodiscard]] const WheelArm& arm() const { return arm_; }
  [[nodiscard]] const WheelState& state() const { return state_; }
  [[nodiscard]] std::int64_t tick() const { return tick_; }

  /// What the sensors say now, while `at` acts.
  [[nodiscard]] Sample sample(const Torques& at) {
    Sample sample;
    sample.stamp_us = tick_ * kTickPeriodUs;
    sample.sequence = static_cast<std::uint16_t>(tick_);
    sample.angle_urad = integer(1e6 * (state_.angle_rad + noise_.angle_rad * angle_noise_.normal()));
    sample.torque_driver_mnm = integer(1e3 * (at.driver.value + noise_.torque_driver_nm * driver_noise_.normal()));
    sample.torque_motor_mnm = integer(1e3 * (at.motor.value + noise_.torque_motor_nm * motor_noise_.normal()));
    return sample;
  }

  /// On to the next tick, the torques running smoothly from `from` to `to`.
  void advance(const Torques& from, const Torques& to) {
    const Cubic net = between(from.driver, to.driver, kTickS) + between(from.unmeasured, to.unmeasured, kTickS) -
                      between(from.motor, to.motor, kTickS);
    const Eigen::Vector4d before(state_.angle_rad, state_.rate_rad_s, 0, 0);
    const Eigen::Vector4d after =
        step_->transition * before + step_->input * Eigen::Vector4d(net.c0, net.c1, net.c2, net.c3);
    state_ = {after(0), after(1)};
    ++tick_;
  }

 private:
  static std::int32_t integer(double x) { return static_cast<std::int32_t>(std::lround(x)); }

  SensorDeviation noise_;
  Random angle_noise_, driver_noise_, motor_noise_;
  WheelArm arm_{};
  std::optional<LinearStep> step_;
  WheelState state_{};
  std::int64_t tick_ = 0;
};

/// Gives the torques of the next tick; sees the wheel, as a driver does.
using Manoeuvre = std::function<Torques(const VirtualWheel&)>;

/// One drive: wheel, manoeuvre and the 100 Hz task, moved on together.
template <class Scalar>
class VirtualDrive {
 public:
  VirtualDrive(const WheelArm& arm, std::uint64_t seed, const SensorDeviation& noise = {},
               const IdentifierSettings<Scalar>& settings = kSteeringWheel<Scalar>)
      : wheel_(arm, seed, noise), task_(settings) {}

  /// Runs `manoeuvre` for `seconds`; `each` is given the sample after every tick.
  template <class Each>
  void run(const Manoeuvre& manoeuvre, double seconds, Each each) {
    const std::int64_t ticks = std::llround(seconds / kTickS);
    for (std::int64_t i = 0; i < ticks; ++i) {
      const Torques now = torques_;
      const Sample sample = wheel_.sample(now);
      task_.take(sample);
      each(sample);
      torques_ = manoeuvre(wheel_);
      wheel_.advance(now, torques_);
    }
  }
  void run(const Manoeuvre& manoeuvre, double seconds) {
    run(manoeuvre, seconds, [](const Sample&) {});
  }

  [[nodiscard]] VirtualWheel& wheel() { return wheel_; }
  [[nodiscard]] IdentificationTask<Scalar>& task() { return task_; }
  [[nodiscard]] const WheelIdentifier<Scalar>& identifier() const { return task_.identifier(); }
  [[nodiscard]] double seconds() const { return static_cast<double>(wheel_.tick()) * kTickS; }

  /// What is true now, in the identifier's order.
  [[nodiscard]] Eigen::Vector3d truth() const {
    return {wheel_.arm().inertia_kgm2, wheel_.arm().damping_nms_per_rad, wheel_.arm().stiffness_nm_per_rad};
  }
  [[nodiscard]] double value(int parameter) const { return static_cast<double>(identifier().value()(parameter)); }
  [[nodiscard]] double deviation(int parameter) const {
    return static_cast<double>(identifier().standard_deviation()(parameter));
  }
  [[nodiscard]] double relative_error(int parameter) const { return value(parameter) / truth()(parameter) - 1; }

 private:
  VirtualWheel wheel_;
  IdentificationTask<Scalar> task_;
  Torques torques_{};
};

}  // namespace steerid
