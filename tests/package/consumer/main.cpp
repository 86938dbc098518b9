// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A firmware of one second that consumes the project: its own back end carries the task, the wheel stands still.
#include <cstdint>
#include <cstdio>

#include "app/run_loop.hpp"
#include "app/task.hpp"
#include "identifier/identifier.hpp"
#include "port/port.hpp"

namespace {

constexpr std::int64_t kTicks = 100;

class OneSecond {
 public:
  steerid::Status wait_tick() {
    if (ticks_ == kTicks) return steerid::Status::kEndOfStream;
    ++ticks_;
    return steerid::Status::kOk;
  }
  steerid::Status read_sample(steerid::Sample& sample) const {
    sample = {};
    sample.stamp_us = ticks_ * steerid::kTickPeriodUs;
    sample.sequence = static_cast<std::uint16_t>(ticks_);
    return steerid::Status::kOk;
  }
  steerid::Status publish(const steerid::Estimate& estimate) {
    last_ = estimate;
    return steerid::Status::kOk;
  }
  steerid::Status request_probe_torque(std::int32_t) { return steerid::Status::kOk; }
  void set_valid(bool) {}
  void set_fault(bool) {}
  void kick_watchdog() {}

  [[nodiscard]] const steerid::Estimate& last() const { return last_; }

 private:
  std::int64_t ticks_ = 0;
  steerid::Estimate last_;
};

}  // namespace

int main() {
  OneSecond hal;
  steerid::IdentificationTask<float> task;
  if (steerid::run_loop(hal, task) != steerid::Status::kOk) return 1;
  std::printf("last estimate at %lld us, inertia %s\n", static_cast<long long>(hal.last().stamp_us),
              steerid::name(hal.last().inertia.state));
  // A wheel that never moves excites nothing: whatever the task says, it must not say that the inertia is known.
  return hal.last().stamp_us == kTicks * steerid::kTickPeriodUs && task.identifier().sound() &&
                 hal.last().inertia.state != steerid::ParameterState::kValid
             ? 0
             : 1;
}
