// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Real-time habits of a process: its memory stays in RAM, and it runs before everything that is not real-time.
#pragma once

#include <string>

namespace steerid::linux_gpiod {

/// Locks all memory, present and future, and asks for SCHED_FIFO at `priority` (1 to 99; 0 asks for nothing). Returns
/// what was not granted, as a sentence for the log, or an empty string. Never fails: without rights the daemon runs on
/// as an ordinary process.
std::string become_realtime(int priority);

}  // namespace steerid::linux_gpiod
