// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// gpio_line.hpp on libgpiod 1.x.
#include <gpiod.h>
#include <poll.h>

#include <cerrno>

#include "linux_gpiod/failure.hpp"
#include "linux_gpiod/gpio_line.hpp"

namespace steerid::linux_gpiod {

struct LineRequest {
  gpiod_line* line;
  ~LineRequest() { gpiod_line_close_chip(line); }  // releases the line, too
};

void LineRelease::operator()(LineRequest* request) const { delete request; }

namespace {

constexpr const char* kOnPermission =
    "let the daemon's user read and write the chip (docs/linux_ecu.md has a udev rule)";

gpiod_line* find(const LineConfig& config) {
  if (config.chip.empty()) {
    gpiod_line* const line = gpiod_line_find(config.name.c_str());
    if (line == nullptr) {
      throw Failure("no GPIO chip that can be opened has a line named " + config.name + "; gpioinfo lists them all");
    }
    return line;
  }
  gpiod_chip* const chip = gpiod_chip_open_lookup(config.chip.c_str());
  if (chip == nullptr) {
    throw Failure("cannot open GPIO chip " + config.chip + ": " + reason(errno, kOnPermission) +
                  "; gpiodetect lists the chips");
  }
  gpiod_line* const line =
      config.name.empty() ? gpiod_chip_get_line(chip, config.offset) : gpiod_chip_find_line(chip, config.name.c_str());
  if (line == nullptr) {
    const std::string lines = std::to_string(gpiod_chip_num_lines(chip));
    gpiod_chip_close(chip);
    throw Failure("there is no " + describe(config) + ", which has " + lines + " lines; gpioinfo lists them");
  }
  return line;
}

int flags(const LineConfig& config) {
  int flags = config.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (config.bias == Bias::kDisabled) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
  if (config.bias == Bias::kPullUp) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (config.bias == Bias::kPullDown) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  return flags;
}

LineHandle request(const LineConfig& config, int type, bool level) {
  LineHandle handle(new LineRequest{find(config)});
  const char* const user = gpiod_line_consumer(handle->line);
  const std::string used_by = user == nullptr ? "another program" : user;
  const gpiod_line_request_config how{.consumer = kConsumer, .request_type = type, .flags = flags(config)};
  if (gpiod_line_request(handle->line, &how, level ? 1 : 0) == 0) return handle;
  if (errno == EBUSY) throw Failure(describe(config) + " is in use by " + used_by + "; stop it or take another line");
  throw Failure("cannot request " + describe(config) + ": " + reason(errno, kOnPermission) +
                (config.bias == Bias::kAsIs ? "" : "; the chip may not know this bias"));
}

}  // namespace

OutputLine::OutputLine(const LineConfig& line, bool level)
    : request_(request(line, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT, level)) {}

Status OutputLine::set(bool level) {
  return gpiod_line_set_value(request_->line, level ? 1 : 0) == 0 ? Status::kOk : Status::kIoError;
}

InputLine::InputLine(const LineConfig& line) : request_(request(line, GPIOD_LINE_REQUEST_DIRECTION_INPUT, false)) {}

Status InputLine::read(bool& level) {
  const int value = gpiod_line_get_value(request_->line);
  if (value < 0) return Status::kIoError;
  level = value != 0;
  return Status::kOk;
}

EdgeLine::EdgeLine(const LineConfig& line) : request_(request(line, GPIOD_LINE_REQUEST_EVENT_RISING_EDGE, false)) {}

int EdgeLine::descriptor() const { return gpiod_line_event_get_fd(request_->line); }

Status EdgeLine::read(std::int64_t& stamp_ns) {
  pollfd waiting{.fd = descriptor(), .events = POLLIN, .revents = 0};
  if (::poll(&waiting, 1, 0) < 0 || (waiting.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return Status::kIoError;
  if ((waiting.revents & POLLIN) == 0) return Status::kNoData;
  gpiod_line_event event{};
  if (gpiod_line_event_read(request_->line, &event) != 0) return Status::kIoError;
  stamp_ns = static_cast<std::int64_t>(event.ts.tv_sec) * 1'000'000'000 + event.ts.tv_nsec;
  return Status::kOk;
}

}  // namespace steerid::linux_gpiod
