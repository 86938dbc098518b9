// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the firmware told of the driver along a record: state and hands, from when to when.
//
// The firmware tells of a driver whatever it is fed. Nothing is told on, and one sentence says why, where
//
//   the record is counted in other units than the port's, a linear drive say (apps/firmware_run.hpp);
//   J is known and less than the lightest wheel's alone, of a rim transducer less than half of the lightest arm's: a
//   servo, a robot's leg;
//   the record is in doubt, and what is told rests on it;
//   no state and no hands were told at any time: that takes a valid C, or a torsion bar and a wheel that is let go.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/firmware_run.hpp"
#include "apps/identification.hpp"
#include "port/estimate.hpp"

namespace steerid {

struct DriverSpan {
  double from_s = 0;
  double to_s = 0;  ///< when the next one begins, or the last estimate
  DriverState state = DriverState::kUnknown;
  HandCount hands = HandCount::kUnknown;
};

struct DriverTimeline {
  std::vector<DriverSpan> spans;  ///< in order, without a hole
  std::string none_since;         ///< why there are none, a clause without a full stop; empty where there are
};

/// `found` is the answer to the whole record.
[[nodiscard]] DriverTimeline driver_timeline(const FirmwareRun& run, const Identification& found);

/// What the firmware told of a driver all the same, where none is to be told of: `unknown` from beginning to end.
void forget_driver(FirmwareRun& run);

/// For the terminal: the state at the end, shares of the time, the latest spans; or one line that says why not.
[[nodiscard]] std::string driver_lines(const DriverTimeline& timeline);

/// {"state":,"hands":,"timeline":[{"from_s":,"to_s":,"state":,"hands":}, ..]}; state and hands at the end. Both null,
/// with a "reason" and no timeline, where nothing is told.
[[nodiscard]] nlohmann::ordered_json driver_json(const DriverTimeline& timeline);

}  // namespace steerid
