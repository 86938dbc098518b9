// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "sensors/column_sensors.hpp"

namespace steerid {
namespace {

/// Streams of chance behind those of SensorSuite: a channel takes two, 2 n and 2 n + 1.
enum Stream : std::uint64_t { kBar = 4, kRim = 5, kProbe = 6 };

}  // namespace

ColumnSensorDefects ColumnSensorDefects::realistic() {
  ColumnSensorDefects defects{.wheel = SensorDefects::realistic(), .torque_bar = {}, .torque_rim = {}, .probe = {}};
  defects.torque_bar.noise.sd = 0.02;
  defects.torque_bar.resolution.step = 0.005;
  defects.torque_rim.noise.sd = 0.03;
  defects.torque_rim.resolution.step = 0.005;
  defects.probe.resolution.step = 0.001;
  return defects;
}

ColumnSensors::ColumnSensors(const ColumnSensorDefects& defects, std::uint64_t seed)
    : wheel_(defects.wheel, seed),
      torque_bar_(defects.torque_bar, seed, kBar),
      torque_rim_(defects.torque_rim, seed, kRim),
      probe_(defects.probe, seed, kProbe) {}

ColumnMeasurement ColumnSensors::read(const ColumnSignals& signals) {
  const Analogue analogue = wheel_.sample({{}, signals.torque_motor, signals.angle});
  const std::int64_t instant_us = analogue.sampled_us;
  ColumnMeasurement measured;
  measured.sampled_us = instant_us;
  measured.wheel = wheel_.convert(analogue);
  measured.wheel.torque_driver_nm = 0;
  auto valid = static_cast<unsigned>(measured.wheel.valid_bits & ~kTorqueDriverValid);
  const auto take = [&](sensor::Channel& channel, const Cubic& signal, std::uint8_t bit) {
    channel.extend(signal);
    const sensor::Channel::Reading reading = channel.convert(channel.analogue(instant_us), instant_us);
    if (reading.valid) valid |= bit;
    return reading.value;
  };
  measured.torque_bar_nm = take(torque_bar_, signals.torque_bar, kTorqueBarValid);
  measured.torque_rim_nm = take(torque_rim_, signals.torque_rim, kTorqueRimValid);
  measured.probe_nm = take(probe_, signals.probe, kProbeValid);
  measured.wheel.valid_bits = static_cast<std::uint8_t>(valid);
  return measured;
}

Sample to_sample(const ColumnMeasurement& measurement, std::uint16_t sequence) {
  Sample sample = to_sample(measurement.wheel, sequence);
  sample.torque_bar_mnm = to_int32(measurement.torque_bar_nm * 1e3);
  sample.torque_rim_mnm = to_int32(measurement.torque_rim_nm * 1e3);
  sample.probe_mnm = to_int32(measurement.probe_nm * 1e3);
  return sample;
}

}  // namespace steerid
