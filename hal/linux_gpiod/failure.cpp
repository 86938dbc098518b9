// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_gpiod/failure.hpp"

#include <cerrno>
#include <cstring>

namespace steerid::linux_gpiod {

std::string reason(int error_number, const std::string& advice_on_permission) {
  std::string text = std::strerror(error_number);
  if (error_number == EACCES || error_number == EPERM) text += "; " + advice_on_permission;
  return text;
}

}  // namespace steerid::linux_gpiod
