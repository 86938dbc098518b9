// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// gpio_line.hpp on libgpiod 2.x.
#include <gpiod.h>
#include <poll.h>

#include <cerrno>
#include <filesystem>

#include "linux_gpiod/failure.hpp"
#include "linux_gpiod/gpio_line.hpp"

namespace steerid::linux_gpiod {

struct LineRequest {
  gpiod_line_request* request = nullptr;
  unsigned offset = 0;
  gpiod_edge_event_buffer* events = nullptr;

  ~LineRequest() {
    if (events != nullptr) gpiod_edge_event_buffer_free(events);
    if (request != nullptr) gpiod_line_request_release(request);
  }
};

void LineRelease::operator()(LineRequest* request) const { delete request; }

namespace {

constexpr const char* kOnPermission =
    "let the daemon's user read and write the chip (docs/linux_ecu.md has a udev rule)";

/// Everything of libgpiod that is freed by a function of its own.
template <class T, void (*Free)(T*)>
struct FreeWith {
  void operator()(T* object) const { Free(object); }
};
template <class T, void (*Free)(T*)>
using Owned = std::unique_ptr<T, FreeWith<T, Free>>;
using Chip = Owned<gpiod_chip, gpiod_chip_close>;
using Settings = Owned<gpiod_line_settings, gpiod_line_settings_free>;
using Lines = Owned<gpiod_line_config, gpiod_line_config_free>;
using Request = Owned<gpiod_request_config, gpiod_request_config_free>;
using Info = Owned<gpiod_line_info, gpiod_line_info_free>;

struct Place {
  Chip chip;
  unsigned offset;
};

Place find_anywhere(const LineConfig& config) {
  for (const auto& entry : std::filesystem::directory_iterator("/dev")) {
    if (!gpiod_is_gpiochip_device(entry.path().c_str())) continue;
    Chip chip(gpiod_chip_open(entry.path().c_str()));
    const int offset = chip ? gpiod_chip_get_line_offset_from_name(chip.get(), config.name.c_str()) : -1;
    if (offset >= 0) return {std::move(chip), static_cast<unsigned>(offset)};
  }
  throw Failure("no GPIO chip that can be opened has a line named " + config.name + "; gpioinfo lists them all");
}

Place find(const LineConfig& config) {
  if (config.chip.empty()) return find_anywhere(config);
  const std::string path = config.chip.front() == '/' ? config.chip : "/dev/" + config.chip;
  Chip chip(gpiod_chip_open(path.c_str()));
  if (!chip) {
    throw Failure("cannot open GPIO chip " + config.chip + ": " + reason(errno, kOnPermission) +
                  "; gpiodetect lists the chips");
  }
  int offset = static_cast<int>(config.offset);
  if (!config.name.empty()) offset = gpiod_chip_get_line_offset_from_name(chip.get(), config.name.c_str());
  if (offset < 0) throw Failure("there is no " + describe(config) + "; gpioinfo lists them");
  return {std::move(chip), static_cast<unsigned>(offset)};
}

gpiod_line_bias bias(Bias bias) {
  switch (bias) {
    case Bias::kDisabled:
      return GPIOD_LINE_BIAS_DISABLED;
    case Bias::kPullUp:
      return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::kPullDown:
      return GPIOD_LINE_BIAS_PULL_DOWN;
    case Bias::kAsIs:
      break;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

enum class Use : std::uint8_t { kOutput, kInput, kRisingEdges };

LineHandle request(const LineConfig& config, Use use, bool level) {
  const Place place = find(config);
  const Info info(gpiod_chip_get_line_info(place.chip.get(), place.offset));
  if (!info) throw Failure("there is no " + describe(config) + "; gpioinfo lists the lines");
  if (gpiod_line_info_is_used(info.get())) {
    const char* const user = gpiod_line_info_get_consumer(info.get());
    throw Failure(describe(config) + " is in use by " + (user == nullptr ? "another program" : user) +
                  "; stop it or take another line");
  }
  const Settings settings(gpiod_line_settings_new());
  const Lines lines(gpiod_line_config_new());
  const Request how(gpiod_request_config_new());
  if (!settings || !lines || !how) throw std::bad_alloc();
  gpiod_line_settings_set_active_low(settings.get(), config.active_low);
  gpiod_line_settings_set_bias(settings.get(), bias(config.bias));
  gpiod_line_settings_set_direction(settings.get(),
                                    use == Use::kOutput ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT);
  gpiod_line_settings_set_output_value(settings.get(), level ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE);
  if (use == Use::kRisingEdges) gpiod_line_settings_set_edge_detection(settings.get(), GPIOD_LINE_EDGE_RISING);
  gpiod_line_config_add_line_settings(lines.get(), &place.offset, 1, settings.get());
  gpiod_request_config_set_consumer(how.get(), kConsumer);
  LineHandle handle(new LineRequest{.offset = place.offset});
  handle->request = gpiod_chip_request_lines(place.chip.get(), how.get(), lines.get());
  if (handle->request == nullptr) {
    throw Failure("cannot request " + describe(config) + ": " + reason(errno, kOnPermission) +
                  (config.bias == Bias::kAsIs ? "" : "; the chip may not know this bias"));
  }
  if (use == Use::kRisingEdges) handle->events = gpiod_edge_event_buffer_new(1);
  return handle;
}

}  // namespace

OutputLine::OutputLine(const LineConfig& line, bool level) : request_(request(line, Use::kOutput, level)) {}

Status OutputLine::set(bool level) {
  const gpiod_line_value value = level ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
  return gpiod_line_request_set_value(request_->request, request_->offset, value) == 0 ? Status::kOk : Status::kIoError;
}

InputLine::InputLine(const LineConfig& line) : request_(request(line, Use::kInput, false)) {}

Status InputLine::read(bool& level) {
  const gpiod_line_value value = gpiod_line_request_get_value(request_->request, request_->offset);
  if (value == GPIOD_LINE_VALUE_ERROR) return Status::kIoError;
  level = value == GPIOD_LINE_VALUE_ACTIVE;
  return Status::kOk;
}

EdgeLine::EdgeLine(const LineConfig& line) : request_(request(line, Use::kRisingEdges, false)) {}

int EdgeLine::descriptor() const { return gpiod_line_request_get_fd(request_->request); }

Status EdgeLine::read(std::int64_t& stamp_ns) {
  pollfd waiting{.fd = descriptor(), .events = POLLIN, .revents = 0};
  if (::poll(&waiting, 1, 0) < 0 || (waiting.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return Status::kIoError;
  if ((waiting.revents & POLLIN) == 0) return Status::kNoData;
  if (gpiod_line_request_read_edge_events(request_->request, request_->events, 1) != 1) return Status::kIoError;
  gpiod_edge_event* const event = gpiod_edge_event_buffer_get_event(request_->events, 0);
  stamp_ns = static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event));
  return Status::kOk;
}

}  // namespace steerid::linux_gpiod
