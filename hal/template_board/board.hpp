// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A board to start from: every peripheral that LinkedEcu asks for (ecu/peripherals.hpp), none of them there yet. Copy
// the folder, fill the bodies in, and follow docs/porting.md. It compiles, links and runs nowhere.
#pragma once

#include <cstdint>
#include <span>

#include "link/messages.hpp"

namespace steerid::template_board {

class Board {
 public:
  /// The next byte that the line's interrupt has put into a ring of at least 256 bytes.
  bool receive(std::uint8_t& byte);
  /// Into a ring of at least 256 bytes that the line's interrupt empties; all of it or nothing.
  bool send(std::span<const std::uint8_t> bytes);
  [[nodiscard]] bool can_send() const;
  /// wfi, unless an interrupt has come since the last call.
  void sleep();

  /// A timer of 10 ms whose interrupt counts.
  void run_timer(bool on);
  [[nodiscard]] std::uint32_t timer_ticks() const;
  void start_stopwatch();
  [[nodiscard]] std::uint32_t stopwatch_us() const;

  void set_lines(bool valid, bool fault);
  void start_watchdog();
  void kick_watchdog();
  void reset(bool keep_saved);

  [[nodiscard]] link::Identity identity() const;
  [[nodiscard]] std::uint32_t overflows() const;
};

}  // namespace steerid::template_board
