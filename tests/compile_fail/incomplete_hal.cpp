// A back end that lacks one of the port's calls is turned down by the concept, and the message names the call.
// error: kick_watchdog\(\).* invalid
#include "port/port.hpp"

namespace {

struct Complete {
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

static_assert(steerid::Hal<Complete>);
