// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What has to be known of a record before it is identified: how large the machine is, whether a constant torque acts
// on it, and whether its torques seem to be written the wrong way round. Two batch fits, and up to four more where
// those leave a doubt.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/firmware_run.hpp"
#include "log/record.hpp"

namespace steerid {

struct FirstLook {
  PortUnits units;                 ///< see port_units_for(inertia)
  bool torque_offset = false;      ///< a constant torque is there: beyond kOffsetInSd standard deviations
  std::vector<std::string> notes;  ///< whole sentences for the user
  std::string misfit;              ///< that no wheel explains much of the angle; empty when one does
  std::string doubt;               ///< why no answer to this record is credible; empty when there is no reason
};

/// Five: one record in two million has such an offset by chance, and a contract without one is not given up lightly.
inline constexpr double kOffsetInSd = 5.0;

/// That the firmware was told of another machine than a steering wheel.
[[nodiscard]] std::string no_wheel_words(const PortUnits& units);

/// `torque_offset`, when given, is the user's word and is not questioned. `record` is at 100 Hz.
FirstLook first_look(const Record& record, std::optional<bool> torque_offset);

}  // namespace steerid
