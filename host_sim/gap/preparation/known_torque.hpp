// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What of a record's torques is known to have driven the wheel.
//
// A torque sensor's noise did not drive the wheel, but a model that is driven with the record is. Where the noise is
// larger than the torque, as between the lines of a probe and above the drive, the best estimate of the torque is next
// to nothing (Wiener), and a model that takes the noise for torque gains by any response that lets less of it through:
// it is a regressor with errors, whose coefficient they pull to zero (Fuller, Measurement Error Models, 1987).
//
// Every channel of every gap-free stretch, without the line between its ends, has its Fourier lines weighed by
//
//   w = max(0, 1 - v/p),  p the mean power of the nine lines around, or a line's own if that is more, v the noise's
//
// A probe's lines stand alone: weighed by what is around them they would be too small, and the response too large.
// Of the noise's power a share of w (1 + 0.35 (1 - w)), w a mean over such lines, is left, with what was lost of the
// torque: never more than all of it.
// Cost: two transforms a channel.
#pragma once

#include <vector>

#include "log/record.hpp"

namespace steerid::gap {

struct KnownTorque {
  Record record;  ///< with the torques as they are known
  /// Of one stretch: what is left of the noises' power, both channels together, on lines equally spaced from zero to
  /// half the sampling rate.
  struct Left {
    std::size_t first = 0;  ///< its samples in the record
    std::size_t end = 0;
    std::vector<double> share;
  };
  std::vector<Left> left{};
};

/// `driver_nm2`, `motor_nm2`: variances of the channels' white noise. Stretches of less than 4 s stay as they are.
[[nodiscard]] KnownTorque known_torque(const Record& record, double driver_nm2, double motor_nm2);

}  // namespace steerid::gap
