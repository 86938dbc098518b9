// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The loop turns down a back end that lacks one of the port's calls, and the message names the call.
// error: kick_watchdog\(\).* invalid
#include "app/run_loop.hpp"

namespace {

struct BackEnd {
  steerid::Status wait_tick() { return steerid::Status::kEndOfStream; }
  steerid::Status read_sample(steerid::Sample&) { return steerid::Status::kNoData; }
  steerid::Status publish(const steerid::Estimate&) { return steerid::Status::kOk; }
  steerid::Status request_probe_torque(std::int32_t) { return steerid::Status::kOk; }
  void set_valid(bool) {}
  void set_fault(bool) {}
#ifndef MUST_NOT_COMPILE
  void kick_watchdog() {}
#endif
};

}  // namespace

steerid::Status use() {
  BackEnd hal;
  steerid::IdentificationTask<float> task;
  return steerid::run_loop(hal, task);
}
