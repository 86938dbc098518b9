// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Frames of a CAN log as a log: the signals that the DBC files of --dbc name, each message with its own stamps.
//
// A signal is called by its name; where two messages have one of that name, MESSAGE.SIGNAL.
#pragma once

#include <memory>

#include "log/log_source.hpp"

namespace steerid {

/// Of candump, ASC and BLF. Throws BadInput without a DBC, and where that cannot be read.
[[nodiscard]] std::unique_ptr<LogSource> open_candump(OpenedLog log);
[[nodiscard]] std::unique_ptr<LogSource> open_asc(OpenedLog log);
[[nodiscard]] std::unique_ptr<LogSource> open_blf(OpenedLog log);

}  // namespace steerid
