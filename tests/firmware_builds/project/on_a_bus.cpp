// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The seven calls on a CAN bus.
#include "app/run_loop.hpp"
#include "can/estimate_messages.hpp"
#include "can/sample_messages.hpp"
#include "port/port.hpp"

// From can_driver.cpp.
bool take_frame(steerid::can::Frame& frame);
bool send_frame(const steerid::can::Frame& frame);

extern "C" void run_ecu();

namespace {

class Bus {
 public:
  steerid::Status wait_tick() { return steerid::Status::kOk; }
  steerid::Status read_sample(steerid::Sample& sample) {
    for (steerid::can::Frame frame; take_frame(frame);) {
      if (assembly_.take(frame, sample) == steerid::Status::kOk) return steerid::Status::kOk;
    }
    return steerid::Status::kNoData;
  }
  steerid::Status publish(const steerid::Estimate& estimate) {
    bool sent = true;
    for (const steerid::can::Frame& frame : messages_.next(estimate, assembly_.counters()))
      sent = send_frame(frame) && sent;
    return sent ? steerid::Status::kOk : steerid::Status::kIoError;
  }
  steerid::Status request_probe_torque(std::int32_t torque_mnm) {
    const steerid::can::Frame frame = steerid::can::probe_request(torque_mnm, alive_);
    alive_ = steerid::can::next_alive(alive_);
    return send_frame(frame) ? steerid::Status::kOk : steerid::Status::kIoError;
  }
  void set_valid(bool level) { valid_ = level; }
  void set_fault(bool level) { fault_ = level; }
  void kick_watchdog() {}

 private:
  steerid::can::SampleAssembly assembly_;
  steerid::can::EstimateMessages messages_;
  std::uint8_t alive_ = 0;
  volatile bool valid_ = false;
  volatile bool fault_ = true;
};

Bus bus;
steerid::IdentificationTask<float> task;

}  // namespace

void run_ecu() { static_cast<void>(steerid::run_loop(bus, task)); }
