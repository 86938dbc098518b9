// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/take_over_drive.hpp"

#include <cmath>

#include "experiment/multisine.hpp"
#include "experiment/tasks.hpp"
#include "plant/plant.hpp"
#include "reproduction/stiffness_drift.hpp"
#include "sensors/sensor_suite.hpp"

namespace steerid {
namespace {

constexpr double kSeam_s = 1.0;  // how long a driver's torque takes to come and go

struct Leg {
  double duration_s;
  DriverState state;
  HandCount hands;
};

constexpr std::array kLegs{
    Leg{30, DriverState::kBraced, HandCount::kOne},    Leg{30, DriverState::kRelaxed, HandCount::kOne},
    Leg{30, DriverState::kRelaxed, HandCount::kTwo},   Leg{30, DriverState::kBraced, HandCount::kTwo},
    Leg{20, DriverState::kHandsOff, HandCount::kNone}, Leg{30, DriverState::kBraced, HandCount::kOne}};

HandPosition hands_of(const Leg& leg, HandPosition one_hand) {
  const auto grip = static_cast<std::size_t>(one_hand) % 3;
  return kAllHandPositions[leg.hands == HandCount::kTwo ? grip + 3 : grip];
}

TaskKind task_of(const Leg& leg) { return leg.state == DriverState::kRelaxed ? TaskKind::kActive : TaskKind::kPassive; }

WheelArm arm_of(const Leg& leg, const VirtualSubject& subject, HandPosition hands) {
  return leg.state == DriverState::kHandsOff ? kWheelAlone : subject.arm(task_of(leg), hands);
}

/// 0 at both ends of a leg, 1 between: smooth over kSeam_s.
double presence(double into_s, double duration_s) {
  const double u = std::clamp(std::min(into_s, duration_s - into_s) / kSeam_s, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

class Drive {
 public:
  Drive(const VirtualSubject& subject, const TakeOverSettings& settings)
      : subject_(subject),
        settings_(settings),
        probe_({.rms_nm = settings.probe_rms_nm}),
        sensors_(SensorDefects::realistic(), settings.seed) {
    probe_now_ = probe_.next();
  }

  void run(const Leg& leg, std::uint64_t seed, TakeOverDrive& out) {
    const HandPosition hands = hands_of(leg, settings_.one_hand);
    const WheelArm arm = arm_of(leg, subject_, hands);
    TaskSettings settings = task_settings(task_of(leg), hands, seed);
    settings.arm = arm;
    settings.unmeasured_percent = settings_.unmeasured_percent;
    Task task(settings);
    const bool drifts = leg.state != DriverState::kHandsOff;
    const std::vector<Effect> effects = stiffness_drift(drifts ? settings_.stiffness_swing : 0.0, seed);
    Plant plant(effects, {.wheel = arm, .seed = seed});
    plant.start(0.0, state_);
    const auto ticks = static_cast<int>(std::lround(leg.duration_s / kTickS));
    for (int tick = 0; tick < ticks; ++tick) {
      TaskTorques torques = task.next();
      const bool held = leg.state != DriverState::kHandsOff;
      const double from = held ? presence(tick * kTickS, leg.duration_s) : 0.0;
      const double to = held ? presence((tick + 1) * kTickS, leg.duration_s) : 0.0;
      torques.driver = faded(torques.driver, from, to);
      torques.motor = faded(torques.motor, from, to);
      torques.unmeasured = faded(torques.unmeasured, from, to);
      advance(plant, torques, out);
    }
    state_ = plant.state();
    const double end_s = static_cast<double>(tick_) * kTickS;
    out.truth.push_back({end_s - leg.duration_s, end_s, leg.state, leg.hands, arm});
  }

 private:
  /// The piece times a weight that goes from one value to another over the tick: values and slopes at the ends.
  static Cubic faded(const Cubic& piece, double from, double to) {
    const double rate = (to - from) / kTickS;
    return Cubic::hermite(from * piece.c0, from * piece.c1 + rate * piece.c0, to * piece.at(kTickS),
                          to * piece.slope(kTickS) + rate * piece.at(kTickS), kTickS);
  }

  void advance(Plant& plant, const TaskTorques& torques, TakeOverDrive& out) {
    const SignalPoint probe_before = probe_now_;
    probe_now_ = probe_.next();
    const Cubic motor = torques.motor + between(probe_before, probe_now_, kTickS);
    const WheelState from = plant.state();
    plant.advance(torques.driver + torques.unmeasured, motor, kTickS);
    const WheelState to = plant.state();
    const Measurement read = sensors_.read(
        {torques.driver, motor, Cubic::hermite(from.angle_rad, from.rate_rad_s, to.angle_rad, to.rate_rad_s, kTickS)});
    out.record.time_s.push_back(static_cast<double>(tick_++) * kTickS);
    out.record.torque_driver_nm.push_back(read.torque_driver_nm);
    out.record.torque_motor_nm.push_back(read.torque_motor_nm);
    out.record.angle_rad.push_back(read.angle_rad);
  }

  const VirtualSubject& subject_;
  TakeOverSettings settings_;
  Multisine probe_;
  SignalPoint probe_now_;
  SensorSuite sensors_;
  WheelState state_;
  std::size_t tick_ = 0;
};

}  // namespace

TakeOverDrive make_take_over_drive(const VirtualSubject& subject, const TakeOverSettings& settings) {
  TakeOverDrive out;
  Drive drive(subject, settings);
  std::uint64_t seed = settings.seed * 100;
  for (const Leg& leg : kLegs) drive.run(leg, seed++, out);
  return out;
}

}  // namespace steerid
