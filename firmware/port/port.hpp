// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The port: everything the 100 Hz task asks of its surroundings. A back end (microcontroller, embedded Linux,
// simulation, replay) is any type that models `Hal`; there is no base class and no virtual call.
//
// Who calls what, in this order, once a tick (docs/hal_contract.md):
//   wait_tick()      blocks until the next tick. kOk, kLate (the deadline was missed; the tick counts), kEndOfStream
//                    (leave the loop; never on a target). In simulation it moves time on by one period.
//   read_sample(s)   the newest sample. kOk, kNoData (none since the last call; s unchanged), kIoError.
//   publish(e)       hands the estimate out. kOk, kIoError (the task goes on).
//   request_probe_torque(mnm)  the torque the task would like the EPS to add, 0 when it wants none.
//   set_valid(b), set_fault(b) two lines towards the EPS.
//   kick_watchdog()  last, so that a task that hangs anywhere is caught.
// No call may block except wait_tick, and none may throw.
#pragma once

#include <concepts>
#include <cstdint>

#include "base/status.hpp"
#include "port/estimate.hpp"
#include "port/sample.hpp"

namespace steerid {

template <class H>
concept Hal = requires(H hal, Sample& sample, const Estimate& estimate, std::int32_t torque_mnm, bool level) {
  { hal.wait_tick() } -> std::same_as<Status>;
  { hal.read_sample(sample) } -> std::same_as<Status>;
  { hal.publish(estimate) } -> std::same_as<Status>;
  { hal.request_probe_torque(torque_mnm) } -> std::same_as<Status>;
  { hal.set_valid(level) } -> std::same_as<void>;
  { hal.set_fault(level) } -> std::same_as<void>;
  { hal.kick_watchdog() } -> std::same_as<void>;
};

}  // namespace steerid
