// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The least that a start-up does: constructors, then the loop. Nobody runs it.
#include <cstdint>

extern "C" {
extern std::uint32_t stack_top;
extern void (*init_array_begin[])();
extern void (*init_array_end[])();
void run_ecu();
[[noreturn]] void start();
}

[[gnu::section(".vectors"), gnu::used]] static const struct {
  const std::uint32_t* stack;
  void (*reset)();
} vectors = {&stack_top, start};

extern "C" void start() {
  for (auto* construct = init_array_begin; construct != init_array_end; ++construct) (*construct)();
  run_ecu();
  for (;;) {
  }
}
