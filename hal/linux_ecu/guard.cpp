// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_ecu/guard.hpp"

#include <linux/sockios.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <optional>

#include "linux_ecu/journal.hpp"
#include "linux_gpiod/failure.hpp"
#include "linux_gpiod/state_file.hpp"

namespace steerid::linux_ecu {
namespace {

using linux_gpiod::Descriptor;
using linux_gpiod::Failure;
using linux_gpiod::OutputLine;

enum class Kind : std::uint8_t { kKick, kSave, kDone };

struct Message {
  Kind kind = Kind::kKick;
  SavedEstimate estimate;
};

void sleep_ms(long ms) {
  const timespec time{.tv_sec = 0, .tv_nsec = ms * 1'000'000};
  ::nanosleep(&time, nullptr);
}

void write_state(const Config& config, const SavedEstimate& estimate) {
  if (config.state_file.empty()) return;
  try {
    linux_gpiod::StateFile file(config.state_file);
    if (TwoSlots<linux_gpiod::StateFile>(file, config.wheel).save(estimate) == Status::kOk) return;
    log(Level::kWarning, "the estimate could not be written to %s", config.state_file.c_str());
  } catch (const Failure& failure) {
    log(Level::kWarning, "%s", failure.what());
  }
}

/// Writes estimates one after the other, each in a process of its own.
class Writer {
 public:
  explicit Writer(const Config& config) : config_(&config) {}

  void write(const SavedEstimate& estimate, const Descriptor& socket) {
    next_ = estimate;
    go_on(socket);
  }
  /// Begins with what waits when the last one is done.
  void go_on(const Descriptor& socket) {
    if (process_ > 0 && ::waitpid(process_, nullptr, WNOHANG) == 0) return;
    process_ = 0;
    if (!next_) return;
    const SavedEstimate estimate = *next_;
    next_.reset();
    process_ = ::fork();
    if (process_ < 0) log(Level::kWarning, "the estimate could not be written: no process for it");
    if (process_ != 0) return;
    ::prctl(PR_SET_NAME, "steerid-writer");
    ::close(socket.number());  // or the daemon would not see its guard die meanwhile
    write_state(*config_, estimate);
    std::_Exit(0);
  }
  /// Until all is written.
  void finish(const Descriptor& socket) {
    for (go_on(socket); process_ > 0; go_on(socket)) sleep_ms(1);
  }

 private:
  const Config* config_;
  std::optional<SavedEstimate> next_;
  pid_t process_ = 0;
};

/// Why the guard stopped listening.
enum class End : std::uint8_t { kDone, kDied, kHung };

End listen(const Descriptor& socket, const Config& config) {
  bool kicked = false;
  Writer writer(config);
  for (;;) {
    pollfd waiting{.fd = socket.number(), .events = POLLIN, .revents = 0};
    const int ready = ::poll(&waiting, 1, kicked ? Guard::kHungMs : -1);
    if (ready < 0) continue;
    if (ready == 0) return End::kHung;
    Message message;
    const ssize_t bytes = ::recv(socket.number(), &message, sizeof message, 0);
    if (bytes <= 0) return End::kDied;
    if (message.kind == Kind::kDone) {
      writer.finish(socket);
      return End::kDone;
    }
    if (message.kind == Kind::kSave) writer.write(message.estimate, socket);
    writer.go_on(socket);
    kicked = kicked || message.kind == Kind::kKick;
  }
}

/// The kernel closes a dying process's descriptors one after the other: the lines may be free a little after the
/// socket.
void make_safe_after_death(const Config& config) {
  constexpr int kTries = 200;
  std::string reason;
  for (int i = 0; i < kTries; ++i) {
    reason = drive_safe_levels(config);
    if (reason.empty()) {
      log(Level::kError, "the daemon is gone; the outputs are at their safe levels");
      return;
    }
    sleep_ms(5);
  }
  log(Level::kError, "the daemon is gone and its outputs could not be driven to their safe levels: %s", reason.c_str());
}

[[noreturn]] void guard(Descriptor socket, const Config& config, pid_t daemon) {
  ::prctl(PR_SET_NAME, "steerid-guard");
  // A stop is for the daemon, which says so here when it is done.
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGQUIT}) std::signal(signal, SIG_IGN);
  switch (listen(socket, config)) {
    case End::kDone:
      std::_Exit(0);
    case End::kHung:
      log(Level::kError, "no tick was finished for %d ms; killing the daemon", Guard::kHungMs);
      ::kill(daemon, SIGKILL);
      break;
    case End::kDied:
      break;
  }
  make_safe_after_death(config);
  std::_Exit(1);
}

}  // namespace

std::string drive_safe_levels(const Config& config) {
  std::string reasons;
  const auto safe = [&reasons](const std::optional<linux_gpiod::LineConfig>& line, bool level) {
    if (!line) return;
    try {
      OutputLine output(*line, level);
    } catch (const Failure& failure) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(failure.what());
    }
  };
  safe(config.lines.valid, false);
  safe(config.lines.fault, true);
  safe(config.lines.heartbeat, false);
  return reasons;
}

Guard::Guard(const Config& config) {
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair.data()) != 0) {
    throw Failure("cannot make a socket for the guard: " + linux_gpiod::reason(errno, ""));
  }
  Descriptor ours(pair[0]);
  Descriptor its(pair[1]);
  const pid_t daemon = ::getpid();
  process_ = ::fork();
  if (process_ < 0) throw Failure("cannot start the guard process: " + linux_gpiod::reason(errno, ""));
  if (process_ == 0) {
    ours.close();
    guard(std::move(its), config, daemon);
  }
  socket_ = std::move(ours);
}

Guard::~Guard() {
  const Message done{.kind = Kind::kDone, .estimate = {}};
  Status told = Status::kNoData;
  const bool reads = unread_kicks_ <= kDeadKicks;
  for (int ms = 0; reads && ms < kLastWriteMs; ++ms) {
    if (told == Status::kNoData) told = send(&done, sizeof done);
    if (::waitpid(process_, nullptr, WNOHANG) != 0) return;
    sleep_ms(1);
  }
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

Status Guard::send(const void* message, std::size_t bytes) {
  if (::send(socket_.number(), message, bytes, MSG_DONTWAIT | MSG_NOSIGNAL) == static_cast<ssize_t>(bytes)) {
    return Status::kOk;
  }
  return errno == EAGAIN || errno == EWOULDBLOCK ? Status::kNoData : Status::kIoError;
}

Status Guard::kick() {
  int unread_bytes = 0;
  const bool read_all = ::ioctl(socket_.number(), SIOCOUTQ, &unread_bytes) == 0 && unread_bytes == 0;
  unread_kicks_ = read_all ? 1 : unread_kicks_ + 1;
  if (unread_kicks_ > kDeadKicks) return Status::kIoError;
  const Message kick;
  const Status status = send(&kick, sizeof kick);
  return status == Status::kNoData ? Status::kOk : status;  // it has enough to read
}

Status Guard::save(const SavedEstimate& estimate) {
  const Message message{.kind = Kind::kSave, .estimate = estimate};
  return send(&message, sizeof message);
}

}  // namespace steerid::linux_ecu
