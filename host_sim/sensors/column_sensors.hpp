// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The sensors of a whole column: those of the wheel (sensors/sensor_suite.hpp), torsion bar, rim and what the EPS says
// of its probe, all read together once a tick and carried by the same message.
//
// Nobody measures the driver's voluntary torque there: its channel is absent.
#pragma once

#include "sensors/sensor_suite.hpp"

namespace steerid {

struct ColumnSensorDefects {
  SensorDefects wheel;                ///< angle, torque_motor, jitter and message_loss; torque_driver is not used
  sensor::ChannelDefects torque_bar;  ///< Nm
  sensor::ChannelDefects torque_rim;  ///< Nm
  sensor::ChannelDefects probe;       ///< Nm

  /// Every defect off.
  static ColumnSensorDefects none() { return {}; }
  /// The wheel's as in SensorDefects::realistic(); bar noise 20 mNm, rim noise 30 mNm, both in steps of 5 mNm; the
  /// probe is a number that the EPS was sent, in steps of 1 mNm.
  static ColumnSensorDefects realistic();
};

/// What truly happened over one tick.
struct ColumnSignals {
  Cubic torque_motor;
  Cubic angle;
  Cubic torque_bar;
  Cubic torque_rim;
  Cubic probe;
};

struct ColumnMeasurement {
  Measurement wheel;  ///< its valid bits are those of all channels
  std::int64_t sampled_us = 0;
  double torque_bar_nm = 0;
  double torque_rim_nm = 0;
  double probe_nm = 0;
};

class ColumnSensors {
 public:
  ColumnSensors(const ColumnSensorDefects& defects, std::uint64_t seed);

  /// As SensorSuite::read.
  [[nodiscard]] ColumnMeasurement read(const ColumnSignals& signals);

 private:
  SensorSuite wheel_;
  sensor::Channel torque_bar_;
  sensor::Channel torque_rim_;
  sensor::Channel probe_;
};

/// The measurement as the bus delivers it; values beyond int32 stop at its ends.
[[nodiscard]] Sample to_sample(const ColumnMeasurement& measurement, std::uint16_t sequence);

}  // namespace steerid
