// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An MCAP file as a log: the numbers in its messages, in JSON or in ROS 2's CDR. A number is a column, called by its
// topic and its path, as "/steering/state/position[0]".
//
// A message's stamp is the one that it has itself (header/stamp, stamp or timestamp, of sec and nanosec), which its
// sender set; else when it was sent. Which fields there are is told by each topic's first hundred messages. The file is
// read twice; from a pipe it is held in memory, 256 MiB of it at most.
#pragma once

#include <memory>

#include "log/log_source.hpp"

namespace steerid {

/// Throws BadInput where no message is of a kind that can be read.
[[nodiscard]] std::unique_ptr<LogSource> open_mcap(OpenedLog log);

}  // namespace steerid
