// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_gpiod/tick.hpp"

#include <poll.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <string>

#include "linux_gpiod/failure.hpp"
#include "port/sample.hpp"

namespace steerid::linux_gpiod {
namespace {

constexpr std::int64_t kPeriodNs = kTickPeriodUs * 1000;

}  // namespace

std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

Tick::Tick(EdgeLine* edges, int stop)
    : edges_(edges), stop_(stop), timer_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  if (!timer_.open()) throw Failure("cannot make a timer: " + reason(errno, ""));
  if (edges_ == nullptr) start_timer();
}

void Tick::start_timer() {
  const timespec period{.tv_sec = 0, .tv_nsec = kPeriodNs};
  const itimerspec every{.it_interval = period, .it_value = period};
  due_ns_ = monotonic_ns();
  ::timerfd_settime(timer_.number(), 0, &every, nullptr);
}

Status Tick::wait() {
  std::array<pollfd, 2> waiting{
      {{.fd = stop_, .events = POLLIN, .revents = 0},
       {.fd = edges_ != nullptr ? edges_->descriptor() : timer_.number(), .events = POLLIN, .revents = 0}}};
  int ready = 0;
  do {
    ready = ::poll(waiting.data(), waiting.size(), edges_ != nullptr ? kSilenceMs : -1);
  } while (ready < 0 && errno == EINTR);
  if (waiting[0].revents != 0) return Status::kEndOfStream;
  ++counters_.ticks;
  return edges_ != nullptr ? edge_tick() : timer_tick();
}

Status Tick::edge_tick() {
  const std::int64_t before_ns = due_ns_;
  std::int64_t stamp_ns = 0;
  int edges = 0;
  Status status = edges_->read(stamp_ns);
  for (; status == Status::kOk; status = edges_->read(stamp_ns)) {
    due_ns_ = stamp_ns;
    ++edges;
  }
  if (status == Status::kIoError) {
    edges_ = nullptr;
    start_timer();
    return Status::kIoError;
  }
  if (edges == 0) {
    ++counters_.silent;
    due_ns_ = monotonic_ns();
    return Status::kLate;
  }
  // By the stamps, too: the kernel's queue may have been too short for all of them.
  const std::int64_t periods = before_ns == 0 ? 1 : (due_ns_ - before_ns + kPeriodNs / 2) / kPeriodNs;
  const std::int64_t passed = std::max<std::int64_t>(edges, periods);
  counters_.missed += static_cast<std::uint64_t>(passed - 1);
  return passed == 1 ? Status::kOk : Status::kLate;
}

Status Tick::timer_tick() {
  std::uint64_t expired = 0;
  if (::read(timer_.number(), &expired, sizeof expired) != static_cast<ssize_t>(sizeof expired) || expired == 0) {
    return Status::kLate;
  }
  due_ns_ += static_cast<std::int64_t>(expired) * kPeriodNs;
  counters_.missed += expired - 1;
  return expired == 1 ? Status::kOk : Status::kLate;
}

}  // namespace steerid::linux_gpiod
