// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_gpiod/gpio_line.hpp"

namespace steerid::linux_gpiod {

std::string describe(const LineConfig& line) {
  const std::string which = line.name.empty() ? std::to_string(line.offset) : line.name;
  return "line " + which + (line.chip.empty() ? "" : " of " + line.chip);
}

}  // namespace steerid::linux_gpiod
