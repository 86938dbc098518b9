// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a board must be able to do so that LinkedEcu makes the port of it. docs/porting.md goes through them one by one;
// hal/template_board is a board to start from.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>

#include "link/messages.hpp"

namespace steerid {

template <class P>
concept Peripherals = requires(P board, const P& seen, std::uint8_t& byte, std::span<const std::uint8_t> bytes,
                               bool on) {
  /// The next byte that arrived; false when there is none.
  { board.receive(byte) } -> std::same_as<bool>;
  /// Queues all of it for sending, or nothing and false when there is no room. Never waits.
  { board.send(bytes) } -> std::same_as<bool>;
  /// True when send() has room for `kMostFrame` bytes twice over.
  { board.can_send() } -> std::same_as<bool>;
  /// Until something has happened since the last call: a byte, room for one, a timer tick. It may return early.
  { board.sleep() } -> std::same_as<void>;
  /// The 100 Hz timer on or off; how often it has ticked.
  { board.run_timer(on) } -> std::same_as<void>;
  { seen.timer_ticks() } -> std::same_as<std::uint32_t>;
  /// Time since start_stopwatch(); never less than it was, held at the end of what it can measure.
  { board.start_stopwatch() } -> std::same_as<void>;
  { board.stopwatch_us() } -> std::same_as<std::uint32_t>;
  /// Two lines towards the EPS.
  { board.set_lines(on, on) } -> std::same_as<void>;
  /// A watchdog that from then on stops the loop 100 ms after the last kick, and resets the board within as much again.
  { board.start_watchdog() } -> std::same_as<void>;
  { board.kick_watchdog() } -> std::same_as<void>;
  /// Does not return. Whether what is saved is to be kept is up to the board's storage.
  { board.reset(on) } -> std::same_as<void>;
  { seen.identity() } -> std::same_as<link::Identity>;
  /// Overflows of the arithmetic, for the health message.
  { seen.overflows() } -> std::same_as<std::uint32_t>;
};

}  // namespace steerid
