// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One sensor channel: the defects in the order in which the signal meets them.
//
//   signal -> lag -> delay -> [sample] -> gain -> bias -> noise -> saturation -> resolution -> dropout -> stuck
//   transducer  transport                 amplifier                 converter      bus          receiver
//
// Everything is off by default; then the channel delivers the signal to the last bit.
//
// Nyquist: the channel reads its signal's value at an instant. There is no anti-alias filter in it unless the same
// `lag` is set on all channels, and none is needed for the tasks of experiment/tasks.hpp, whose torques stay below
// 20 Hz, nor for the wheel's angle, which falls with 1/f^2 above its natural frequency. A motor torque that is held
// over the tick has images above 50 Hz; it is read as the value that acts from that tick on, see experiment/tasks.hpp.
// A high-frequency disturbance of the user's own does alias, as it would in a real channel without filter.
//
// No allocation after the constructor. Cost: see tests/bench/simulated_bench.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plant/cubic.hpp"
#include "port/sample.hpp"
#include "sensors/bias.hpp"
#include "sensors/delay.hpp"
#include "sensors/dropout.hpp"
#include "sensors/gain.hpp"
#include "sensors/lag.hpp"
#include "sensors/noise.hpp"
#include "sensors/random.hpp"
#include "sensors/resolution.hpp"
#include "sensors/saturation.hpp"
#include "sensors/stuck.hpp"

namespace steerid::sensor {

struct ChannelDefects {
  Lag lag;
  Delay delay;
  Gain gain;
  Bias bias;
  Noise noise;
  Saturation saturation;
  Resolution resolution;
  Dropout dropout;
  Stuck stuck;
};

class Channel {
 public:
  struct Reading {
    double value = 0;   ///< in the channel's unit
    bool valid = true;  ///< false when a flagged dropout hides the value
  };

  /// `stream` keeps this channel's chance apart from that of the others.
  Channel(const ChannelDefects& defects, std::uint64_t seed, std::uint64_t stream);

  /// The true signal from the end of the last piece on, for one tick. Before the first piece it stood still.
  void extend(const Cubic& signal);

  /// The signal after lag and delay at `instant_us`, which lies in the newest piece; the first piece starts at 0.
  [[nodiscard]] double analogue(std::int64_t instant_us) const;

  /// What the channel delivers for the analogue value `x` at `instant_us`. Call once for each sample.
  [[nodiscard]] Reading convert(double x, std::int64_t instant_us);

 private:
  struct Piece {
    Cubic signal;
    double lagged_at_start = 0;
  };
  /// A power of two above the longest delay in ticks.
  static constexpr std::size_t kPieces = 64;
  static_assert(Delay::kLongestUs / kTickPeriodUs + 1 < static_cast<std::int64_t>(kPieces));

  [[nodiscard]] bool lagging(std::int64_t instant_us) const;

  ChannelDefects defects_;
  DropoutProcess dropout_;
  Random noise_random_;
  Random dropout_random_;
  double tick_decay_ = 0;
  std::array<Piece, kPieces> pieces_{};
  std::int64_t extended_ = 0;  ///< pieces so far
  double last_good_ = 0;       ///< what a lost sample repeats
  double delivered_ = 0;       ///< what a stuck channel repeats
  bool started_ = false;
};

}  // namespace steerid::sensor
