// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_gpiod/can_socket.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "can/layout.hpp"
#include "linux_gpiod/failure.hpp"

namespace steerid::linux_gpiod {
namespace {

constexpr int kCallsBetweenLooks = 100;

/// An open socket bound to `interface`, or one that is not open, with the reason in errno.
Descriptor bound_socket(const std::string& interface) {
  Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!socket.open()) return socket;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) return Descriptor();
  const std::array<can_filter, 3> wanted{{{can::kWheelAngleId, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG},
                                          {can::kWheelTorqueId, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG},
                                          {can::kWheelTimeId, CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG}}};
  if (::setsockopt(socket.number(), SOL_CAN_RAW, CAN_RAW_FILTER, wanted.data(), sizeof wanted) != 0 ||
      ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return Descriptor();
  }
  return socket;
}

}  // namespace

CanSocket::CanSocket(const std::string& interface) : interface_(interface), socket_(bound_socket(interface)) {
  if (!socket_.open()) {
    const bool no_can = errno == EAFNOSUPPORT;
    const std::string why = reason(errno, "the daemon's user must be allowed to open CAN sockets");
    throw Failure("cannot use CAN interface " + interface + ": " + why +
                  (no_can ? "; the kernel has no CAN: load its module can, and that of the controller"
                          : "; `ip link` lists the interfaces"));
  }
}

void CanSocket::look_again() {
  if (interface_.empty() || --calls_until_look_ > 0) return;
  calls_until_look_ = kCallsBetweenLooks;
  Descriptor again = bound_socket(interface_);
  if (again.open()) socket_ = std::move(again);
}

Status CanSocket::read(can::Frame& frame) {
  can_frame raw{};
  for (;;) {
    const ssize_t bytes = ::recv(socket_.number(), &raw, sizeof raw, MSG_DONTWAIT);
    if (bytes == static_cast<ssize_t>(sizeof raw)) break;
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return Status::kNoData;
    look_again();
    return Status::kIoError;
  }
  frame.id = static_cast<std::uint16_t>(raw.can_id & CAN_SFF_MASK);
  frame.length = std::min<std::uint8_t>(raw.can_dlc, 8);
  std::copy_n(raw.data, frame.data.size(), frame.data.begin());
  return Status::kOk;
}

Status CanSocket::write(const can::Frame& frame) {
  can_frame raw{};
  raw.can_id = frame.id;
  raw.can_dlc = frame.length;
  std::copy(frame.data.begin(), frame.data.end(), raw.data);
  const ssize_t bytes = ::send(socket_.number(), &raw, sizeof raw, MSG_DONTWAIT | MSG_NOSIGNAL);
  return bytes == static_cast<ssize_t>(sizeof raw) ? Status::kOk : Status::kIoError;
}

}  // namespace steerid::linux_gpiod
