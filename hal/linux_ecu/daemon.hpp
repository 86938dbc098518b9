// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The daemon: the 100 Hz task on a Board, with its guard, its saved estimate and its log, until it is told to stop.
#pragma once

#include "linux_ecu/config.hpp"

namespace steerid::linux_ecu {

/// How often the estimate is kept while the loop runs.
inline constexpr int kTicksBetweenSaves = 30'000;  // 5 minutes
/// How often it is looked whether there is one to keep.
inline constexpr int kTicksBetweenLooks = 100;

/// Runs until SIGTERM or SIGINT. Returns the process's exit code: 0 after a clean stop, 3 when the loop failed. Throws
/// linux_gpiod::Failure when something that the config names cannot be had.
int run_daemon(const Config& config);

/// Opens all that the config names, says what it found and lets go again. Throws linux_gpiod::Failure.
void dry_run(const Config& config);

}  // namespace steerid::linux_ecu
