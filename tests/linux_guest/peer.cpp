// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// peer: what stands beside the daemon in the guest.
//
//   peer drive IF EXPECTED CHIP LINE
//                            plays the EPS: sends the samples of EXPECTED (made by expected_drive), each once the
//                            daemon has answered the one before, and compares every answer with the frames that stand
//                            there: all bits but the alive counter and the checksum, which count ticks and not samples.
//                            LINE changes when a sample is on the bus, so that whoever pulls sample_ready knows
//                            (the driver's state: of any of the ten samples before or after, since the task looks at
//                            the driver every tenth tick, and ticks without a sample count)
//   peer samples IF MS       sends samples of a wheel at rest every 10 ms, whatever comes back
//   peer hold CHIP LINE MS   keeps a line to itself
//   peer as UID PROGRAM ...  runs a program as another user
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "can/layout.hpp"
#include "can/sample_messages.hpp"
#include "linux_gpiod/can_socket.hpp"
#include "linux_gpiod/failure.hpp"
#include "linux_gpiod/gpio_line.hpp"
#include "linux_gpiod/tick.hpp"

namespace {

using namespace steerid;
using linux_gpiod::CanSocket;
using linux_gpiod::Descriptor;

constexpr int kAnswerMs = 500;
constexpr int kTries = 4;
constexpr std::size_t kShown = 5;
constexpr std::size_t kUnanswered = 3;  ///< nobody is there

/// A socket that sees everything on the interface.
Descriptor open_bus(const char* interface) {
  Descriptor bus(::socket(PF_CAN, SOCK_RAW, CAN_RAW));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface));
  if (::bind(bus.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw linux_gpiod::Failure("peer: cannot open the bus");
  }
  return bus;
}

struct Line {
  Sample sample;
  std::map<unsigned, std::string> answers;  ///< identifier to bytes in hex
};

std::vector<Line> read_expected(const char* path) {
  std::vector<Line> lines;
  std::ifstream file(path);
  for (std::string text; std::getline(file, text);) {
    std::istringstream words(text);
    Line line;
    unsigned valid = 0;
    words >> line.sample.stamp_us >> line.sample.angle_urad >> line.sample.torque_driver_mnm >>
        line.sample.torque_motor_mnm >> line.sample.torque_bar_mnm >> line.sample.torque_rim_mnm >>
        line.sample.probe_mnm >> line.sample.sequence >> valid;
    line.sample.valid_bits = static_cast<std::uint8_t>(valid);
    for (std::string answer; words >> answer;) {
      line.answers[static_cast<unsigned>(std::stoul(answer.substr(0, 3), nullptr, 16))] = answer.substr(4);
    }
    lines.push_back(line);
  }
  return lines;
}

/// The bytes with checksum and alive counter as zeros: byte 0 and the low half of byte 1.
std::string without_counting(std::string hex) {
  hex[0] = hex[1] = hex[3] = '0';
  return hex;
}

std::string hex(const can_frame& frame) {
  std::string text;
  for (const std::uint8_t byte : frame.data) {
    char two[3];
    std::snprintf(two, sizeof two, "%02x", byte);
    text += two;
  }
  return text;
}

/// Collects the daemon's frames until its TaskState tells of `stamp_us`, then one more cycle's rest. The frames of that
/// tick, or fewer when it did not answer in time.
std::map<unsigned, std::string> answer(int bus, std::int64_t stamp_us, std::size_t frames) {
  std::map<unsigned, std::string> got;
  bool ours = false;
  for (pollfd waiting{.fd = bus, .events = POLLIN, .revents = 0}; ::poll(&waiting, 1, kAnswerMs) > 0;) {
    can_frame raw{};
    if (::recv(bus, &raw, sizeof raw, 0) != static_cast<ssize_t>(sizeof raw)) break;
    if (raw.can_id < can::kParameterIds[0] || raw.can_id > can::kDriverOnWheelId) continue;
    if (raw.can_id == can::kProbeRequestId) continue;
    can::Frame frame{.id = static_cast<std::uint16_t>(raw.can_id), .length = raw.can_dlc, .data = {}};
    std::copy_n(raw.data, 8, frame.data.begin());
    got[raw.can_id] = hex(raw);
    if (raw.can_id == can::kTaskStateId) ours = can::get(frame, can::kStamp) == stamp_us;
    if (raw.can_id == can::kDriverOnWheelId && ours && got.size() == frames) return got;
  }
  return {};
}

/// What is wrong with one frame of the answer to sample `at`, as the bytes that were wanted; empty when nothing is.
std::string wanted_instead(const std::vector<Line>& lines, std::size_t at, unsigned id, const std::string& bytes) {
  constexpr std::size_t kDriverTicks = 10;
  const std::size_t slack = id == can::kDriverOnWheelId ? kDriverTicks : 0;
  const std::size_t last = std::min(at + slack, lines.size() - 1);
  for (std::size_t i = at < slack ? 0 : at - slack; i <= last; ++i) {
    if (without_counting(bytes) == without_counting(lines[i].answers.at(id))) return "";
  }
  return lines[at].answers.at(id);
}

int drive(const char* interface, const char* path, const linux_gpiod::LineConfig& on_the_bus) {
  const std::vector<Line> lines = read_expected(path);
  const Descriptor bus = open_bus(interface);
  CanSocket can(interface);
  linux_gpiod::OutputLine sent(on_the_bus, false);
  bool level = false;
  std::uint8_t alive = 0;
  std::size_t frames = 0;
  std::size_t differ = 0;
  std::size_t unanswered = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    for (const can::Frame& frame : can::pack(line.sample, alive)) {
      for (int k = 0; k < kTries && can.write(frame) != Status::kOk; ++k) ::usleep(1000);
    }
    alive = can::next_alive(alive);
    level = !level;
    if (sent.set(level) != Status::kOk) throw linux_gpiod::Failure("cannot set the line");
    const auto got = answer(bus.number(), line.sample.stamp_us, line.answers.size());
    unanswered += got.empty() ? 1 : 0;
    if (unanswered > kUnanswered) break;
    for (const auto& [id, bytes] : got) {
      ++frames;
      const std::string wanted = wanted_instead(lines, i, id, bytes);
      if (wanted.empty() || ++differ > kShown) continue;
      std::printf("PEER sample %u id %03x: %s, expected %s\n", line.sample.sequence, id, bytes.c_str(), wanted.c_str());
    }
  }
  std::printf("PEER samples %zu frames %zu differ %zu unanswered %zu\n", lines.size(), frames, differ, unanswered);
  return differ + unanswered == 0 ? 0 : 1;
}

int samples(const char* interface, int ms) {
  CanSocket can(interface);
  Sample sample;
  std::uint8_t alive = 0;
  sample.stamp_us = linux_gpiod::monotonic_ns() / 1000;
  for (int i = 0; i < ms / 10; ++i) {
    sample.stamp_us += kTickPeriodUs;
    ++sample.sequence;
    for (const can::Frame& frame : can::pack(sample, alive)) static_cast<void>(can.write(frame));
    alive = can::next_alive(alive);
    ::usleep(10'000);
  }
  return 0;
}

linux_gpiod::LineConfig line_of(const char* chip, const char* offset) {
  linux_gpiod::LineConfig config;
  config.chip = chip;
  config.offset = static_cast<unsigned>(std::atoi(offset));
  return config;
}

int hold(const linux_gpiod::LineConfig& line, int ms) {
  const linux_gpiod::InputLine held(line);
  std::puts("PEER holds the line");
  std::fflush(stdout);
  ::usleep(static_cast<unsigned>(ms) * 1000U);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string job = argc > 1 ? argv[1] : "";
  try {
    if (job == "drive" && argc == 6) return drive(argv[2], argv[3], line_of(argv[4], argv[5]));
    if (job == "samples" && argc == 4) return samples(argv[2], std::atoi(argv[3]));
    if (job == "hold" && argc == 5) return hold(line_of(argv[2], argv[3]), std::atoi(argv[4]));
  } catch (const std::exception& error) {
    std::printf("PEER %s\n", error.what());
    return 1;
  }
  if (job == "as" && argc >= 4) {
    if (::setuid(static_cast<uid_t>(std::atoi(argv[2]))) == 0) ::execvp(argv[3], argv + 3);
    std::puts("PEER cannot run the program");
  }
  return 2;
}
