// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The loop that is flashed, simulated and replayed: the same code everywhere, one tick after the other until the back
// end says that there are no more. On a target it never returns.
#pragma once

#include "app/task.hpp"
#include "port/port.hpp"

namespace steerid {

/// Runs `task` on `hal` until kEndOfStream. Returns kOk then, or the status of a wait that failed otherwise: with the
/// fault line high, the valid line low and no probe asked for any more.
/// A failing read counts as a tick without a sample; a failing publish does not stop the identification.
template <class Scalar, Hal H>
Status run_loop(H& hal, IdentificationTask<Scalar>& task) {
  for (;;) {
    const Status tick = hal.wait_tick();
    if (tick == Status::kEndOfStream) return Status::kOk;
    if (tick == Status::kLate) {
      task.late_tick();
    } else if (tick != Status::kOk) {
      static_cast<void>(hal.request_probe_torque(0));
      hal.set_valid(false);
      hal.set_fault(true);
      return tick;
    }
    Sample sample;
    if (hal.read_sample(sample) == Status::kOk) {
      task.take(sample);
    } else {
      task.idle();
    }
    // An estimate that could not be handed out is old by the next tick; the fault line speaks for the link.
    const bool published = hal.publish(task.estimate()) == Status::kOk;
    // An EPS that refuses a probe has its reasons.
    if (hal.request_probe_torque(task.probe_torque_mnm()) != Status::kOk) task.probe_was_refused();
    hal.set_valid(task.valid());
    hal.set_fault(task.fault() || !published);
    hal.kick_watchdog();
  }
}

}  // namespace steerid
