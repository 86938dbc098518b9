// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How late some channels of a record are against the others: by the lag with which a wheel's motion explains the most
// of the torque (fit/motion_fit.hpp).
//
// For each lag the channels are taken earlier by it, and J, B, C and a constant are fitted; the log likelihood of the
// lag is -(n/2) log of the power that stays unexplained, n the samples that are independent behind the fit's Gaussian.
// Every lag of whole samples is tried on the first 30 s, those within 60 ms of the best one on the whole record; the
// least is where the parabola through the best three has it. Its curvature gives the deviation.
//
// What lies in neither the angle nor the torque that is explained moves nothing: then no lag is shown.
//
// Cost: 3 us a sample and a lag.
#pragma once

#include <cstdint>

#include "log/record.hpp"

namespace steerid {

struct ClockLag {
  double late_s = 0;   ///< positive: the channels are later than the others
  double sd_s = 0;     ///< by chance
  bool shown = false;  ///< beyond half a sample, likelier than none by eight nats (four deviations), inside the range
  double unexplained = 1;        ///< share of the torque's power, with the lag
  double unexplained_as_is = 1;  ///< without
};

/// `channels`: their valid bits. `record` is at 100 Hz.
[[nodiscard]] ClockLag clock_lag(const Record& record, std::uint8_t channels, double most_s);

}  // namespace steerid
