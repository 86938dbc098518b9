// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// From reset to run_ecu(): the vector table, memory as C++ expects it, and the interrupts. Nothing else runs before it.
#include <cstdint>

#include "mps2_an386/board.hpp"
#include "mps2_an386/kept_memory.hpp"
#include "mps2_an386/registers.hpp"

// From link.ld.
extern "C" {
extern std::uint32_t stack_top;
extern std::uint32_t data_load, data_begin, data_end, bss_begin, bss_end;
extern void (*init_array_begin[])();
extern void (*init_array_end[])();
void run_ecu();
[[noreturn]] void reset_handler();
}

namespace {

[[gnu::section(".kept"), gnu::used]] steerid::mps2::KeptMemory kept;

/// A fault must not go unseen: the watchdog bites, and the next start says so.
void stop() {
  kept.reset_mark = steerid::mps2::kWatchdogReset;
  for (;;) {
  }
}
void receive_interrupt() { steerid::mps2::Board::the()->byte_arrived(); }
void send_interrupt() { steerid::mps2::Board::the()->byte_left(); }
void tick_interrupt() { steerid::mps2::Board::the()->ticked(); }

using Handler = void (*)();
struct Vectors {
  const std::uint32_t* stack;
  Handler system[15];
  Handler device[2];
};

// The watchdog's first time-out is the NMI; it is not cleared, so the second resets.
[[gnu::section(".vectors"), gnu::used]] constexpr Vectors vectors = {
    &stack_top,
    {reset_handler, stop, stop, stop, stop, stop, nullptr, nullptr, nullptr, nullptr, stop, stop, nullptr, stop,
     tick_interrupt},
    {receive_interrupt, send_interrupt},
};

}  // namespace

steerid::mps2::KeptMemory& steerid::mps2::kept_memory() { return kept; }

extern "C" void reset_handler() {
#ifdef __ARM_FP
  steerid::mps2::coprocessors() = 0xFU << 20U;
  asm volatile("dsb\n isb" ::: "memory");
#endif
  const std::uint32_t* from = &data_load;
  for (std::uint32_t* to = &data_begin; to != &data_end; ++to) *to = *from++;
  for (std::uint32_t* to = &bss_begin; to != &bss_end; ++to) *to = 0;
  for (auto* construct = init_array_begin; construct != init_array_end; ++construct) (*construct)();
  run_ecu();
  stop();
  for (;;) {
  }
}
