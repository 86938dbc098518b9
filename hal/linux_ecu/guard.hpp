// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The daemon's watchdog: a second process that outlives it, for what a killed process cannot do itself.
//
//   the daemon dies      (crash, kill -9) The kernel has released the output lines but left them at their
//                        last levels. The guard requests them, drives the safe levels and ends.
//   the daemon hangs     (no kick for kHungMs) The guard kills it, then does the same.
//   the guard dies, or   (kDeadKicks of which it has read none) kick() answers kIoError. The daemon drives
//   stands still         the safe levels itself and ends, so that systemd starts both anew.
//   both die at once     Two things are left: the board's pull resistors, on chips that reset a released
//                        line, and systemd's ExecStopPost, which runs `steerid-ecu --make-safe`.
//
// It also has the saved estimate written to its file, by a process that lives as long as that takes: a medium may hold
// it up for seconds, and neither the daemon nor its guard. Started before anything else, so that it inherits neither
// lines nor real-time priority. Messages go over a pair of sockets; none of the daemon's calls waits, its end apart.
#pragma once

#include <sys/types.h>

#include <string>

#include "app/saved_state.hpp"
#include "base/status.hpp"
#include "linux_ecu/config.hpp"
#include "linux_gpiod/descriptor.hpp"

namespace steerid::linux_ecu {

class Guard {
 public:
  static constexpr int kHungMs = 200;     ///< twenty periods
  static constexpr int kDeadKicks = 100;  ///< a second
  static constexpr int kLastWriteMs = 4000;

  /// Starts the guard. Throws Failure when no process can be made.
  explicit Guard(const Config& config);
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;
  /// Tells the guard that the outputs are safe already, and waits for its end and for what it is still having written:
  /// for kLastWriteMs at most, then it is killed.
  ~Guard();

  /// Once a tick. kOk, or kIoError when there is no guard any more, or one that reads nothing. The guard waits for
  /// kicks from the first one on.
  Status kick();
  /// Has the guard write the estimate, after the one that is being written. kOk, kNoData when it reads nothing,
  /// kIoError.
  Status save(const SavedEstimate& estimate);

 private:
  Status send(const void* message, std::size_t bytes);

  linux_gpiod::Descriptor socket_;
  pid_t process_ = -1;
  int unread_kicks_ = 0;  ///< since the guard had last read all
};

/// Requests every output of `config` and drives its safe level. What is to be said of those that could not be had,
/// empty when all could.
std::string drive_safe_levels(const Config& config);

}  // namespace steerid::linux_ecu
