// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A sensor that repeats its last message: its channel reads the same to the last digit for half a second and longer.
//
// That is a defect only of a channel whose noise always shows. Two readings of white noise of deviation s, rounded to
// steps d, are equal with a probability of d / (2 sqrt(pi) s): 0.28 for s = d, and of 50 in a row 1e-27. A wheel that
// rests under an encoder without noise reads the same as well, and so does a torque that is commanded and held; these
// channels have no noise but that of their rounding, d / sqrt(12). Therefore a channel freezes where
//
//   s > d                       d is the smallest difference between two of its readings, s its white noise
//   it reads the same for 0.5 s and 20 rows at least, as long as the firmware's (firmware/app/input_supervision.hpp)
//   not at its largest or smallest value, where a limit holds it, nor at zero, where a torque is that is switched off
//
// s is that of log/channel_noise.hpp, of differences that alternate as those of white noise do.
//
// The rows of it are left out, and make a gap. Only the channels of the record's equation are looked at: a motor that
// stands is no fault of a record whose torsion bar is used. Cost: a few passes and a selection a channel.
#pragma once

#include <array>
#include <string>

#include "log/log_format.hpp"
#include "log/record.hpp"

namespace steerid {

struct FrozenChannels {
  std::array<double, kChannels> length_s{};  ///< by channel, of all its frozen stretches

  /// A whole sentence for the user; empty where nothing froze.
  [[nodiscard]] std::string note() const;
};

/// Takes the rows out of `record` in which a channel repeats a reading that it froze at.
[[nodiscard]] FrozenChannels leave_out_frozen(Record& record);

}  // namespace steerid
