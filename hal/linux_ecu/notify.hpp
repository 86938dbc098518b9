// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the daemon tells systemd (sd_notify(3)): that it is ready, that it lives, that it stops. A datagram to the
// socket that systemd names in NOTIFY_SOCKET; without one every call does nothing. Written out here since libsystemd
// cannot be linked statically, which a small image may want.
#pragma once

#include "linux_gpiod/descriptor.hpp"

namespace steerid::linux_ecu {

class Notify {
 public:
  Notify();
  /// "READY=1", "WATCHDOG=1", "STOPPING=1", "STATUS=...". Neither waits nor allocates.
  void tell(const char* state);

 private:
  linux_gpiod::Descriptor socket_;
};

}  // namespace steerid::linux_ecu
