// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Frames to and from one CAN interface, without ever waiting.
//
// The socket outlives the interface: while it is down, or gone (a USB adapter that was pulled), calls answer kIoError;
// once it is up again they work again. A vanished interface is looked for at most every 100 calls of read().
#pragma once

#include <cstdint>
#include <string>

#include "base/status.hpp"
#include "can/frame.hpp"
#include "linux_gpiod/descriptor.hpp"

namespace steerid::linux_gpiod {

class CanSocket {
 public:
  /// Throws Failure when there is no such interface, or no CAN in this kernel.
  explicit CanSocket(const std::string& interface);
  /// On a descriptor that carries struct can_frame datagrams: a socket pair in a test.
  explicit CanSocket(Descriptor connected) : socket_(std::move(connected)) {}

  /// The oldest frame that has arrived. kOk, kNoData, kIoError.
  Status read(can::Frame& frame);
  /// kOk, or kIoError (interface down, or its queue is full: nobody acknowledges).
  Status write(const can::Frame& frame);

  [[nodiscard]] const std::string& interface() const { return interface_; }

 private:
  void look_again();

  std::string interface_;
  Descriptor socket_;
  int calls_until_look_ = 0;
};

}  // namespace steerid::linux_gpiod
