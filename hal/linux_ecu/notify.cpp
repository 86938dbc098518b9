// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_ecu/notify.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace steerid::linux_ecu {

Notify::Notify() {
  const char* const path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  if (path == nullptr || std::strlen(path) < 2 || std::strlen(path) >= sizeof address.sun_path) return;
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, path);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path));
  if (path[0] == '@') address.sun_path[0] = '\0';  // Linux's abstract names
  linux_gpiod::Descriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address), length) == 0) {
    socket_ = std::move(socket);
  }
}

void Notify::tell(const char* state) {
  if (!socket_.open()) return;
  [[maybe_unused]] const ssize_t sent =
      ::send(socket_.number(), state, std::strlen(state), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace steerid::linux_ecu
