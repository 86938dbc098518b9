// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "hil/byte_channel.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include "log/bad_input.hpp"
#include "log/unfinished_files.hpp"

namespace steerid::hil {
namespace {

constexpr const char* kEmulatorEnded =
    "the emulator ended; is qemu-system-arm installed (scripts/images.sh installs it), and the image one for this "
    "board?";

void set_line(int descriptor) {
  termios settings{};
  if (tcgetattr(descriptor, &settings) != 0) return;  // no terminal: a pipe or a pseudo device
  cfmakeraw(&settings);
  cfsetspeed(&settings, B921600);
  settings.c_cflag |= CLOCAL | CREAD;
  tcsetattr(descriptor, TCSANOW, &settings);
}

/// In the child: the emulator with its serial line on our socket. Returns only when there is no emulator.
/// `mux` puts 32 bytes of buffer before the UART, so that its interrupt finds more than one byte and the emulator's
/// two threads meet less often: half the processor time. Its escape key is one that no byte is.
void become_emulator(int socket, const std::string& machine, const std::string& image) {
  const int nothing = ::open("/dev/null", O_WRONLY);
  ::dup2(socket, STDIN_FILENO);
  ::dup2(socket, STDOUT_FILENO);
  ::dup2(nothing, STDERR_FILENO);
  ::execlp("qemu-system-arm", "qemu-system-arm", "-M", machine.c_str(), "-display", "none", "-monitor", "none", "-echr",
           "256", "-chardev", "stdio,id=line,mux=on,signal=off", "-serial", "chardev:line", "-kernel", image.c_str(),
           static_cast<char*>(nullptr));
}

}  // namespace

ByteChannel ByteChannel::open_port(const std::filesystem::path& port) {
  std::error_code unknown;
  const bool a_device = std::filesystem::is_character_file(port, unknown);
  const bool there = std::filesystem::exists(port, unknown);
  const int descriptor = there && !a_device ? -1 : ::open(port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  const std::string error = std::strerror(errno);
  const bool a_line = descriptor >= 0 && ::isatty(descriptor) == 1;
  if (!a_line) {
    if (descriptor >= 0) ::close(descriptor);
    throw bad_input(
        {.file = port.string(),
         .expected = "the serial port of an ECU",
         .found = !there || (a_device && descriptor < 0) ? fmt::format("\"{}\"", error)
                                                         : (a_device ? "a device that is no line" : "a file"),
         .advice = "connect the ECU and name its port, as /dev/ttyACM0; to open it takes the group dialout"});
  }
  (void)::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  set_line(descriptor);
  return {descriptor, 0, port.string()};
}

ByteChannel ByteChannel::start_emulator(const std::string& machine, const std::filesystem::path& image) {
  if (!std::filesystem::exists(image)) {
    throw BadInput(fmt::format(
        "{}: there is no such image; scripts/images.sh in steerid's source folder installs what it takes and "
        "builds build/firmware/steerid-an386.elf and steerid-an385.elf, and --firmware names any other",
        image.string()));
  }
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw BadInput(fmt::format("no line to an emulator: {}", std::strerror(errno)));
  }
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    // A program that is killed outright, or before it knows its child, ends nothing: the kernel ends the emulator then.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    restore_signals_in_child();
    become_emulator(ends[1], machine, image.string());
    ::_exit(127);
  }
  ::close(ends[1]);
  return {ends[0], child, "the emulated ECU"};
}

ByteChannel::ByteChannel(int descriptor, pid_t child, std::string name)
    : descriptor_(descriptor),
      child_(child),
      ended_by_signals_(child > 0 ? std::make_unique<EndsWithProgram>(child) : nullptr),
      name_(std::move(name)) {}

ByteChannel::ByteChannel(ByteChannel&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      child_(std::exchange(other.child_, 0)),
      ended_by_signals_(std::move(other.ended_by_signals_)),
      name_(std::move(other.name_)) {}

ByteChannel::~ByteChannel() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (child_ > 0) {
    ::kill(child_, SIGTERM);
    ::waitpid(child_, nullptr, 0);
  }
}

void ByteChannel::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    // MSG_NOSIGNAL is for sockets only; a serial port never raises SIGPIPE.
    ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == ENOTSOCK) sent = ::write(descriptor_, bytes.data(), bytes.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && child_ > 0) {
      throw BadInput(kEmulatorEnded);
    }
    if (sent < 0) throw BadInput(fmt::format("{}: cannot be written: {}", name_, std::strerror(errno)));
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

std::span<const std::uint8_t> ByteChannel::read(int timeout_ms) {
  pollfd waiting{descriptor_, POLLIN, 0};
  const int ready = ::poll(&waiting, 1, timeout_ms);
  if (ready == 0 || (ready < 0 && errno == EINTR)) return {};
  // A line delivers byte by byte; waking up for each costs more than all the rest of a run.
  if (timeout_ms > 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
  const ssize_t got = ::read(descriptor_, buffer_, sizeof buffer_);
  if (got <= 0) {
    throw BadInput(child_ > 0 ? kEmulatorEnded
                              : fmt::format("{}: the line is closed; is the ECU still connected and powered?", name_));
  }
  return std::span(buffer_).first(static_cast<std::size_t>(got));
}

}  // namespace steerid::hil
