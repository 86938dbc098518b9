// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_gpiod/realtime.hpp"

#include <sched.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>

#include "linux_gpiod/failure.hpp"

namespace steerid::linux_gpiod {
namespace {

constexpr std::size_t kStack = 64 * 1024;

/// Touches the stack that the loop will need, so that no page is missing later.
void touch_stack() {
  std::array<volatile char, kStack> pages{};
  for (std::size_t i = 0; i < pages.size(); i += 4096) pages[i] = 1;
}

}  // namespace

std::string become_realtime(int priority) {
  std::string refused;
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    refused = "memory is not locked (" + reason(errno, "grant CAP_IPC_LOCK or raise LimitMEMLOCK") + ")";
  }
  touch_stack();
  if (priority <= 0) return refused;
  const sched_param wanted{.sched_priority = priority};
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) != 0) {
    refused += (refused.empty() ? "" : "; ") + std::string("SCHED_FIFO was not granted (") +
               reason(errno, "grant CAP_SYS_NICE or raise LimitRTPRIO") + ")";
  }
  return refused;
}

}  // namespace steerid::linux_gpiod
