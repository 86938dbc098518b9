// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The wheel's sensors: three channels read together once a tick, and the bus that carries them.
//
// One reading becomes a row of a record (SI units, doubles) and a Sample of the port (integers: 1 urad, 1 mNm, 1 us).
// Rounding to the port's integers adds an error of 0.29 urad and 0.29 mNm rms, far below any sensor named here.
#pragma once

#include <cstdint>

#include "plant/cubic.hpp"
#include "port/sample.hpp"
#include "sensors/jitter.hpp"
#include "sensors/sensor_channel.hpp"

namespace steerid {

struct SensorDefects {
  sensor::ChannelDefects torque_driver;  ///< Nm
  sensor::ChannelDefects torque_motor;   ///< Nm
  sensor::ChannelDefects angle;          ///< rad
  sensor::Jitter jitter;                 ///< all channels together
  sensor::Dropout message_loss;          ///< the whole sample is lost; `flagged` has no meaning here

  /// Every defect off.
  static SensorDefects none() { return {}; }
  /// A production wheel as in recorded drives: angle noise 0.7 mrad in steps of 0.5 mrad (0.03 degrees), torque sensor
  /// noise 30 mNm in steps of 5 mNm, motor torque noise 9 mNm (a current measured and fed back).
  static SensorDefects realistic();
};

/// What truly happened over one tick.
struct TickSignals {
  Cubic torque_driver;
  Cubic torque_motor;
  Cubic angle;
};

/// The channels at one sampling instant, after lag and delay and before the converters.
struct Analogue {
  std::int64_t sampled_us = 0;  ///< when it was
  std::int64_t stamp_us = 0;    ///< when the stamp will say it was
  double torque_driver_nm = 0;
  double torque_motor_nm = 0;
  double angle_rad = 0;
};

/// What the sensors say about one instant.
struct Measurement {
  std::int64_t stamp_us = 0;
  double torque_driver_nm = 0;
  double torque_motor_nm = 0;
  double angle_rad = 0;
  std::uint8_t valid_bits = kAllChannelsValid;
  bool delivered = true;  ///< false: the message was lost, and the rest says what it would have held
};

class SensorSuite {
 public:
  SensorSuite(const SensorDefects& defects, std::uint64_t seed);

  /// Reads the sensors at the start of the tick whose signals are given (later by the jitter). Ticks follow each other
  /// without gap, the first one starts at 0 us.
  [[nodiscard]] Measurement read(const TickSignals& signals) { return convert(sample(signals)); }

  /// The two halves of read(), for whoever has something to do to the signals in between. Call each once a tick.
  [[nodiscard]] Analogue sample(const TickSignals& signals);
  [[nodiscard]] Measurement convert(const Analogue& analogue);

 private:
  sensor::Channel torque_driver_;
  sensor::Channel torque_motor_;
  sensor::Channel angle_;
  sensor::Jitter jitter_;
  sensor::DropoutProcess message_loss_;
  Random jitter_random_;
  Random message_random_;
  std::int64_t tick_us_ = 0;
};

/// To the nearest; stops at the ends.
[[nodiscard]] std::int32_t to_int32(double value);

/// The measurement as the bus delivers it; values beyond int32 stop at its ends.
[[nodiscard]] Sample to_sample(const Measurement& measurement, std::uint16_t sequence);

}  // namespace steerid
