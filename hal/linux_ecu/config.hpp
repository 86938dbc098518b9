// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The daemon's config file: JSON, // comments allowed. docs/linux_ecu.md explains every key;
// hal/linux_ecu/system/steerid-ecu.json is an example with all of them.
//
//   can         the CAN interface, "can0"                                                             required
//   lines       sample_ready, probe_enable, valid, fault, heartbeat; each {"chip", "line", "active_low", "bias"}, where
//               line is an offset or a name, chip may be left out with a name, bias is "as-is", "disabled", "pull-up"
//               or "pull-down". A line that is absent is not wired.
//   channels    of the samples, those that are used: torque_bar, torque_rim, torque_driver, torque_motor, probe; all
//   that
//               are valid when absent
//   state_file  where the estimate is kept over power-off; absent: it is not
//   wheel       number of the wheel that the estimate belongs to, 0 to 4294967295; 1 when absent
//   wheel_friction_nm  dry friction of the wheel above the torsion bar, Nm, 0 to 20; 0 when absent
//   priority    SCHED_FIFO priority, 1 to 99, 0 for none; 50 when absent
#pragma once

#include <cstdint>
#include <string>

#include "linux_gpiod/board.hpp"
#include "port/sample.hpp"

namespace steerid::linux_ecu {

struct Config {
  std::string can;
  linux_gpiod::BoardLines lines;
  std::uint8_t channels = kEveryChannel;  ///< valid bits that are accepted
  std::string state_file;
  std::uint32_t wheel = 1;
  double wheel_friction_nm = 0;
  int priority = 50;
};

/// Reads `path`. Throws linux_gpiod::Failure with a sentence that names file, line and key, and what to write there.
Config read_config(const std::string& path);
/// The same from text; `path` is for messages.
Config parse_config(const std::string& text, const std::string& path);

}  // namespace steerid::linux_ecu
