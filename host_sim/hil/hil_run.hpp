// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Streams a record through an ECU and compares every estimate with the in-process run.
//
// As fast as both ends can (the default) a frame is a tick, up to kAhead of them on their way at a time. In real time
// the ECU's own timer makes the ticks, and a sample goes out every 10 ms of the host's clock: the estimates are then
// compared by the stamp of their sample, without counters, since ticks and samples may slide against each other. An ECU
// that its watchdog resets meanwhile is started again and listed among the recoveries; nothing is compared after that,
// since nobody knows which samples it lost.
//
// Faults on the wire, drawn by the seed: a sample is lost, damaged, or arrives `delay_ticks` later in place of the one
// that was due then. A reset comes in mid-drive; the ECU goes on from its saved estimate. What the ECU saw is known, so
// that the in-process run sees the same and the bits must still be equal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hil/ecu.hpp"
#include "log/progress.hpp"
#include "log/record.hpp"

namespace steerid::hil {

struct WireFaults {
  double lose = 0;    ///< share of the samples
  double damage = 0;  ///< share
  double delay = 0;   ///< share
  int delay_ticks = 3;
  std::vector<double> resets_s;  ///< seconds after the record's start
  std::uint64_t seed = 1;
};

struct Difference {
  std::size_t tick = 0;
  Estimate ecu;
  Estimate in_process;
};

struct Recovery {
  double at_s = 0;
  link::ResetCause cause = link::ResetCause::kRequested;
  bool restored = false;
  std::optional<double> valid_again_s;  ///< after the reset; nothing when all three never were
};

struct HilResult {
  std::size_t ticks = 0;
  std::size_t lost = 0;
  std::size_t damaged = 0;
  std::size_t delayed = 0;
  std::size_t different = 0;            ///< estimates
  std::vector<Difference> differences;  ///< the first ten
  std::vector<Recovery> recoveries;
  Estimate last;
  link::Health health;

  [[nodiscard]] bool bit_identical() const { return ticks > 0 && different == 0; }
};

/// `progress` is told the ticks done.
HilResult run_as_fast_as_it_goes(Ecu& ecu, const Record& record, const WireFaults& faults, Progress& progress);
HilResult run_in_real_time(Ecu& ecu, const Record& record, Progress& progress);

}  // namespace steerid::hil
