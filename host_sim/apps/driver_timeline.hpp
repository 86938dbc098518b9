// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the firmware told of the driver along a record: state and hands, from when to when.
//
// It speaks of a driver on a steering wheel. Of a record that is counted in other units than the port's, a linear drive
// say, nothing is told (apps/firmware_run.hpp).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/firmware_run.hpp"
#include "port/estimate.hpp"

namespace steerid {

struct DriverSpan {
  double from_s = 0;
  double to_s = 0;  ///< when the next one begins, or the last estimate
  DriverState state = DriverState::kUnknown;
  HandCount hands = HandCount::kUnknown;
};

/// In order, without a hole; empty when the record is of no steering wheel.
using DriverTimeline = std::vector<DriverSpan>;

[[nodiscard]] DriverTimeline driver_timeline(const FirmwareRun& run);

/// For the terminal: the state at the end, shares of the time, the latest spans.
[[nodiscard]] std::string driver_lines(const DriverTimeline& timeline);

/// {"state":,"hands":,"timeline":[{"from_s":,"to_s":,"state":,"hands":}, ..]}; state and hands at the end, null with a
/// "reason" for no steering wheel.
[[nodiscard]] nlohmann::ordered_json driver_json(const DriverTimeline& timeline);

}  // namespace steerid
