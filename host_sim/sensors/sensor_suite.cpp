// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "sensors/sensor_suite.hpp"

#include <algorithm>
#include <limits>

#include "sensors/nearest_whole.hpp"

namespace steerid {
namespace {

/// Streams of chance: a channel takes two, 2 n and 2 n + 1.
enum Stream : std::uint64_t { kDriver = 0, kMotor = 1, kAngle = 2, kJitter = 6, kMessage = 7 };

}  // namespace

std::int32_t to_int32(double value) {
  constexpr double kLowest = std::numeric_limits<std::int32_t>::min();
  constexpr double kHighest = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(nearest_whole(std::clamp(value, kLowest, kHighest)));
}

SensorDefects SensorDefects::realistic() {
  SensorDefects defects;
  defects.angle.noise.sd = 0.0007;
  defects.angle.resolution.step = 0.0005;
  defects.torque_driver.noise.sd = 0.03;
  defects.torque_driver.resolution.step = 0.005;
  defects.torque_motor.noise.sd = 0.009;
  return defects;
}

SensorSuite::SensorSuite(const SensorDefects& defects, std::uint64_t seed)
    : torque_driver_(defects.torque_driver, seed, kDriver),
      torque_motor_(defects.torque_motor, seed, kMotor),
      angle_(defects.angle, seed, kAngle),
      jitter_(defects.jitter),
      message_loss_(defects.message_loss),
      jitter_random_(seed, kJitter),
      message_random_(seed, kMessage) {}

Analogue SensorSuite::sample(const TickSignals& signals) {
  torque_driver_.extend(signals.torque_driver);
  torque_motor_.extend(signals.torque_motor);
  angle_.extend(signals.angle);
  const sensor::Jitter::Instants instants = jitter_.at(tick_us_, jitter_random_);
  tick_us_ += kTickPeriodUs;
  return {instants.sampled_us, instants.stamp_us, torque_driver_.analogue(instants.sampled_us),
          torque_motor_.analogue(instants.sampled_us), angle_.analogue(instants.sampled_us)};
}

Measurement SensorSuite::convert(const Analogue& analogue) {
  const std::int64_t instant_us = analogue.sampled_us;
  const sensor::Channel::Reading driver = torque_driver_.convert(analogue.torque_driver_nm, instant_us);
  const sensor::Channel::Reading motor = torque_motor_.convert(analogue.torque_motor_nm, instant_us);
  const sensor::Channel::Reading angle = angle_.convert(analogue.angle_rad, instant_us);
  const bool lost = message_loss_.lost(instant_us, message_random_);

  std::uint8_t valid = 0;
  if (angle.valid) valid |= kAngleValid;
  if (driver.valid) valid |= kTorqueDriverValid;
  if (motor.valid) valid |= kTorqueMotorValid;
  return {analogue.stamp_us, driver.value, motor.value, angle.value, valid, !lost};
}

Sample to_sample(const Measurement& measurement, std::uint16_t sequence) {
  return {.stamp_us = measurement.stamp_us,
          .angle_urad = to_int32(measurement.angle_rad * 1e6),
          .torque_driver_mnm = to_int32(measurement.torque_driver_nm * 1e3),
          .torque_motor_mnm = to_int32(measurement.torque_motor_nm * 1e3),
          .sequence = sequence,
          .valid_bits = measurement.valid_bits};
}

}  // namespace steerid
