// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "mps2_an386/board.hpp"

#include "mps2_an386/kept_memory.hpp"
#include "mps2_an386/registers.hpp"

namespace steerid::mps2 {
namespace {

constexpr std::uint32_t kBaud = 921'600;
constexpr std::uint32_t kSysTickCounts = 1U << 0U;
constexpr std::uint32_t kSysTickInterrupts = 1U << 1U;
constexpr std::uint32_t kSysTickProcessorClock = 1U << 2U;
constexpr std::uint32_t kStopwatchClocks = 0xFFFFFFU;  // 0.67 s
constexpr std::uint32_t kResetRequest = 0x05FA0004U;

link::ResetCause cause_of_reset() {
  const std::uint32_t mark = kept_memory().reset_mark;
  kept_memory().reset_mark = 0;
  if (mark == kAskedForReset) return link::ResetCause::kRequested;
  return mark == kWatchdogReset ? link::ResetCause::kWatchdog : link::ResetCause::kPowerOn;
}

}  // namespace

Board*& Board::the() {
  static Board* board = nullptr;
  return board;
}

Board::Board(link::Board board, link::Number number, std::uint32_t (*overflow_count)())
    : identity_{.board = board, .number = number, .cause = cause_of_reset(), .restored = 0},
      overflows_(overflow_count) {
  the() = this;
  gpio0().out_enable_set = 3;
  uart0().baud_divider = kClockHz / kBaud;
  // Receiver and its interrupt in one write: a byte that arrives between two would be there without an interrupt.
  uart0().control = kUartSends | kUartReceives | kUartSendInterrupt | kUartReceiveInterrupt;
  // What was on the line before a reset is nobody's; until it is taken the emulator holds back what comes after it.
  static_cast<void>(uart0().data);
  nvic_enable() = 1U << kUart0ReceiveLine | 1U << kUart0SendLine;
}

bool Board::receive(std::uint8_t& byte) {
  if (received_.pop(byte)) return true;
  if ((uart0().state & kUartReceiveFull) == 0) return false;
  // It found no room when it arrived, and no second interrupt comes by itself.
  nvic_pending() = 1U << kUart0ReceiveLine;
  asm volatile("dsb\n isb" ::: "memory");
  return received_.pop(byte);
}

bool Board::send(std::span<const std::uint8_t> bytes) {
  if (sending_.room() < bytes.size()) return false;
  for (const std::uint8_t byte : bytes) sending_.push(byte);
  // The send interrupt speaks when a byte has left; the first one has to be pushed.
  asm volatile("cpsid i" ::: "memory");
  byte_left();
  asm volatile("cpsie i" ::: "memory");
  return true;
}

void Board::sleep() {
  // With interrupts held off, wfi still wakes up from one that waits: none can slip in between look and sleep.
  asm volatile("cpsid i" ::: "memory");
  if (!happened_.load()) asm volatile("wfi" ::: "memory");
  happened_.store(false);
  asm volatile("cpsie i" ::: "memory");
}

void Board::run_timer(bool on) {
  timer_runs_ = on;
  systick().control = 0;
  if (!on) return;
  systick().load = kTickClocks - 1;
  systick().value = 0;
  systick().control = kSysTickCounts | kSysTickInterrupts | kSysTickProcessorClock;
}

// Where no timer makes ticks the system timer is the stopwatch's alone, and stands still between two steps.
void Board::start_stopwatch() {
  if (timer_runs_) {
    stopwatch_tick_ = ticks_.load();
    stopwatch_value_ = systick().value;
    return;
  }
  systick().control = 0;
  systick().load = kStopwatchClocks;
  systick().value = 0;
  systick().control = kSysTickCounts | kSysTickProcessorClock;
}

std::uint32_t Board::stopwatch_us() const {
  constexpr std::uint32_t kClocksPerUs = kClockHz / 1'000'000;
  if (timer_runs_) {
    const std::uint32_t ticks = ticks_.load() - stopwatch_tick_;
    return ((ticks * kTickClocks) + stopwatch_value_ - systick().value) / kClocksPerUs;
  }
  const std::uint32_t left = systick().value;  // 0 until the first clock has loaded it
  systick().control = 0;
  return left == 0 ? 0 : (kStopwatchClocks - left) / kClocksPerUs;
}

void Board::set_lines(bool valid, bool fault) {
  const std::uint32_t levels = (valid ? 1U : 0U) | (fault ? 2U : 0U);
  gpio0().out = levels;
  leds() = levels;
}

// Loaded before it counts. The emulator's counts always, and once it has passed zero twice it resets as soon as it may.
void Board::start_watchdog() {
  watchdog().load = kWatchdogClocks;
  watchdog().clear = 1;
  watchdog().control = 3;
}

void Board::kick_watchdog() { watchdog().clear = 1; }

void Board::reset(bool keep_saved) {
  if (!keep_saved) kept_memory().forget();
  kept_memory().reset_mark = kAskedForReset;
  asm volatile("dsb" ::: "memory");
  reset_control() = kResetRequest;
  for (;;) asm volatile("wfi");
}

void Board::byte_arrived() {
  // Cleared before the byte is taken: the next one may come at once.
  uart0().interrupt = 2;
  // Without room it stays where it is: the emulator's line waits, and a real one is no worse off.
  while ((uart0().state & kUartReceiveFull) != 0 && received_.room() != 0) {
    received_.push(static_cast<std::uint8_t>(uart0().data));
    happened_.store(true);
  }
}

void Board::byte_left() {
  uart0().interrupt = 1;
  std::uint8_t byte = 0;
  while ((uart0().state & kUartSendFull) == 0 && sending_.pop(byte)) uart0().data = byte;
  happened_.store(true);
}

void Board::ticked() {
  ticks_.store(ticks_.load() + 1);
  happened_.store(true);
}

}  // namespace steerid::mps2
