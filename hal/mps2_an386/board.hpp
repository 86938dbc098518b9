// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The peripherals (ecu/peripherals.hpp) of the MPS2 boards: UART 0 at 921600 baud by interrupts, the system timer at
// 100 Hz, the CMSDK watchdog, GPIO 0 (bit 0 `valid`, bit 1 `fault`, both on the LEDs, too), and two saved pages.
//
// One Board exists; the interrupts reach it by Board::the().
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "link/frame.hpp"
#include "mps2_an386/ring.hpp"

namespace steerid::mps2 {

class Board {
 public:
  Board(link::Board board, link::Number number, std::uint32_t (*overflow_count)());

  bool receive(std::uint8_t& byte);
  bool send(std::span<const std::uint8_t> bytes);
  [[nodiscard]] bool can_send() const { return sending_.room() >= 2 * link::kMostFrame; }
  void sleep();

  void run_timer(bool on);
  [[nodiscard]] std::uint32_t timer_ticks() const { return ticks_.load(); }
  void start_stopwatch();
  [[nodiscard]] std::uint32_t stopwatch_us() const;

  void set_lines(bool valid, bool fault);
  void start_watchdog();
  void kick_watchdog();
  void reset(bool keep_saved);

  void restored(bool yes) { identity_.restored = yes ? 1 : 0; }
  [[nodiscard]] link::Identity identity() const { return identity_; }
  [[nodiscard]] std::uint32_t overflows() const { return overflows_(); }

  static Board*& the();

  // From the interrupts only.
  void byte_arrived();
  void byte_left();
  void ticked();

 private:
  static constexpr std::uint32_t kTickClocks = 250'000;        ///< 10 ms
  static constexpr std::uint32_t kWatchdogClocks = 2'500'000;  ///< 100 ms

  Ring<256> received_;
  Ring<512> sending_;
  std::atomic<std::uint32_t> ticks_ = 0;
  std::atomic<bool> happened_ = false;
  std::uint32_t stopwatch_tick_ = 0;
  std::uint32_t stopwatch_value_ = 0;
  bool timer_runs_ = false;
  link::Identity identity_;
  std::uint32_t (*overflows_)();
};

}  // namespace steerid::mps2
