// A firmware of one second that consumes the project: its back end gives the port what a wheel would.
#include <cstdint>
#include <cstdio>

#include "port/port.hpp"

namespace {

class OneSecond {
 public:
  steerid::Status wait_tick() { return ticks_++ < 100 ? steerid::Status::kOk : steerid::Status::kEndOfStream; }
  steerid::Status read_sample(steerid::Sample& sample) {
    sample.stamp_us = ticks_ * steerid::kTickPeriodUs;
    sample.sequence = static_cast<std::uint16_t>(ticks_);
    return steerid::Status::kOk;
  }
  steerid::Status publish(const steerid::Estimate& estimate) {
    last_stamp_us_ = estimate.stamp_us;
    return steerid::Status::kOk;
  }
  steerid::Status request_probe_torque(std::int32_t) { return steerid::Status::kOk; }
  void set_valid(bool) {}
  void set_fault(bool) {}
  void kick_watchdog() {}

  [[nodiscard]] std::int64_t last_stamp_us() const { return last_stamp_us_; }

 private:
  std::int64_t ticks_ = 0;
  std::int64_t last_stamp_us_ = 0;
};

}  // namespace

int main() {
  OneSecond hal;
  steerid::Sample sample;
  steerid::Estimate estimate;
  while (hal.wait_tick() == steerid::Status::kOk) {
    if (hal.read_sample(sample) != steerid::Status::kOk) return 1;
    estimate.stamp_us = sample.stamp_us;
    if (hal.publish(estimate) != steerid::Status::kOk) return 1;
  }
  std::printf("last estimate at %lld us\n", static_cast<long long>(hal.last_stamp_us()));
  return hal.last_stamp_us() == 100 * steerid::kTickPeriodUs ? 0 : 1;
}
