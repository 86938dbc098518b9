// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// When the next 100 Hz tick is due: at the edges of the line `sample_ready`, which the EPS raises when a sample's
// messages are on the bus, or by a timer of 10 ms where that line is not wired.
//
// wait() blocks until then, or until someone asks to stop. Statuses:
//   kOk           a tick, one period after the last
//   kLate         a tick whose deadline was missed: edges or periods went by before wait() was
//                 called (counted in `missed`), or no edge came for kSilenceMs (in `silent`)
//   kEndOfStream  asked to stop
//   kIoError      the line's chip is gone: ticks go on by the timer, and this is said once
//
// Edges that the kernel's queue of 16 could not keep are counted by their stamps. Nothing allocates after construction.
#pragma once

#include <cstdint>

#include "base/status.hpp"
#include "linux_gpiod/descriptor.hpp"
#include "linux_gpiod/gpio_line.hpp"

namespace steerid::linux_gpiod {

struct TickCounters {
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;  ///< periods that went by without a tick
  std::uint64_t silent = 0;  ///< ticks made because no edge came
};

class Tick {
 public:
  static constexpr int kSilenceMs = 25;  ///< two and a half periods

  /// `edges` may be null (the timer then); `stop` becomes readable when the loop has to end. Both outlive this object.
  Tick(EdgeLine* edges, int stop);

  Status wait();

  [[nodiscard]] const TickCounters& counters() const { return counters_; }
  /// When the present tick was due, CLOCK_MONOTONIC: the edge's own stamp, or the timer's expiry.
  [[nodiscard]] std::int64_t due_ns() const { return due_ns_; }

 private:
  Status edge_tick();
  Status timer_tick();
  void start_timer();

  EdgeLine* edges_;
  int stop_;
  Descriptor timer_;
  TickCounters counters_;
  std::int64_t due_ns_ = 0;
};

std::int64_t monotonic_ns();

}  // namespace steerid::linux_gpiod
