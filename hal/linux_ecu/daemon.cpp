// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_ecu/daemon.hpp"

#include <sys/signalfd.h>

#include <cerrno>
#include <csignal>

#include "app/run_loop.hpp"
#include "app/saved_state.hpp"
#include "linux_ecu/guard.hpp"
#include "linux_ecu/journal.hpp"
#include "linux_ecu/notify.hpp"
#include "linux_gpiod/board.hpp"
#include "linux_gpiod/failure.hpp"
#include "linux_gpiod/realtime.hpp"
#include "linux_gpiod/state_file.hpp"

namespace steerid::linux_ecu {
namespace {

using linux_gpiod::Board;
using linux_gpiod::CanSocket;
using linux_gpiod::Descriptor;
using linux_gpiod::StateFile;
using Task = IdentificationTask<float>;

/// Readable when SIGTERM or SIGINT came. SIGHUP is refused: a config that changes under a running loop would move
/// lines.
Descriptor stop_signal() {
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGTERM);
  sigaddset(&stop, SIGINT);
  ::sigprocmask(SIG_BLOCK, &stop, nullptr);
  std::signal(SIGHUP, [](int) {
    log(Level::kWarning, "SIGHUP refused: the config is read at the start only; restart the service instead");
  });
  return Descriptor(::signalfd(-1, &stop, SFD_CLOEXEC | SFD_NONBLOCK));
}

/// A state that is told to the log when it has lasted, so that one that flutters does not fill it.
class LastingState {
 public:
  explicit LastingState(bool first) : told_(first) {}
  /// True when `now` differs from what was told last, and has for kLasting ticks.
  bool changed(bool now) {
    differing_ = now == told_ ? 0 : differing_ + 1;
    if (differing_ < kLasting) return false;
    told_ = now;
    differing_ = 0;
    return true;
  }

 private:
  static constexpr int kLasting = 20;
  bool told_;
  int differing_ = 0;
};

/// The board, watched: what the loop does not know of, once a tick.
class WatchedBoard : public Board {
 public:
  WatchedBoard(const Config& config, int stop, Guard& guard, Task& task)
      : Board(config.lines, CanSocket(config.can), stop), config_(&config), guard_(&guard), task_(&task) {}

  Status wait_tick() {
    if (!guarded_) return Status::kIoError;
    const Status status = Board::wait_tick();
    task_->permit_probe(probe_enabled());
    return status;
  }

  Status read_sample(Sample& sample) {
    const Status status = Board::read_sample(sample);
    sample.valid_bits = static_cast<std::uint8_t>(sample.valid_bits & config_->channels);
    return status;
  }

  void kick_watchdog() {
    Board::kick_watchdog();
    guarded_ = guard_->kick() == Status::kOk;
    notify_.tell(first_ ? "READY=1\nWATCHDOG=1" : "WATCHDOG=1");
    first_ = false;
    remember();
    say_what_changed();
  }

  /// Has what was remembered last written to the state file.
  void save() {
    until_save_ = kTicksBetweenSaves;
    if (remembered_) static_cast<void>(guard_->save(estimate_));
  }

  [[nodiscard]] bool guarded() const { return guarded_; }

 private:
  /// Keeps the estimate at hand while it can be had: when the car is switched off, the EPS is silent before we stop,
  /// and by then the task is in fault.
  void remember() {
    if (--until_save_ % kTicksBetweenLooks == 0 && task_->save(estimate_) == Status::kOk) remembered_ = true;
    if (until_save_ <= 0) save();
  }

  void say_what_changed() {
    if (can_.changed(can_works())) {
      log(can_works() ? Level::kNotice : Level::kWarning,
          can_works() ? "%s takes frames again" : "%s takes no frames: is it up, and is someone on the bus?",
          config_->can.c_str());
    }
    if (lines_.changed(lines_work())) {
      log(Level::kError, "a GPIO line no longer answers: is its chip still there? Ticks go on by the timer");
    }
    if (agree_.changed(samples_agree())) {
      log(samples_agree() ? Level::kNotice : Level::kError,
          samples_agree() ? "the samples on %s agree again"
                          : "the samples on %s contradict each other and are refused: is there a second sender?",
          config_->can.c_str());
    }
    if (fault_.changed(task_->fault())) {
      log(task_->fault() ? Level::kWarning : Level::kNotice,
          task_->fault() ? "fault: no plausible samples" : "samples again");
    }
    if (valid_.changed(task_->valid())) {
      log(Level::kInfo, task_->valid() ? "all parameters valid" : "not all parameters are valid");
    }
  }

  const Config* config_;
  Guard* guard_;
  Task* task_;
  Notify notify_;
  bool first_ = true;
  bool guarded_ = true;
  LastingState can_{true};
  LastingState lines_{true};
  LastingState agree_{true};
  LastingState fault_{false};
  LastingState valid_{false};
  int until_save_ = kTicksBetweenSaves;
  bool remembered_ = false;
  SavedEstimate estimate_;
};

void restore(const Config& config, Task& task) {
  if (config.state_file.empty()) return;
  StateFile file(config.state_file);
  SavedEstimate saved;
  Status status = TwoSlots<StateFile>(file, config.wheel).load(saved);
  if (status == Status::kOk) status = task.restore(saved);
  if (status == Status::kOk) {
    log(Level::kInfo, "restored the last estimate from %s", config.state_file.c_str());
  } else if (status != Status::kNoData) {
    log(Level::kWarning, "%s is not used: %s; starting without a saved estimate", config.state_file.c_str(),
        name(status));
  }
}

void say_how_it_went(const WatchedBoard& board) {
  const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  const auto& ticks = board.tick_counters();
  log(Level::kInfo, "ticks %llu, missed %llu, without an edge %llu; samples %llu, dropped %llu", number(ticks.ticks),
      number(ticks.missed), number(ticks.silent), number(board.counters().samples), number(board.counters().dropped));
  const can::SampleCounters& bus = board.sample_counters();
  log(Level::kInfo, "on the bus: frames corrupt %u, repeated %u; samples incomplete %u, refused %u",
      unsigned{bus.corrupt}, unsigned{bus.repeated}, unsigned{bus.incomplete}, unsigned{bus.refused});
  const auto& latency = board.latency();
  const auto quantile = [&latency](double part) { return static_cast<long long>(latency.quantile_us(part)); };
  log(Level::kInfo, "edge to heartbeat, us: median %lld, 90 %% %lld, 99 %% %lld, largest %lld", quantile(0.5),
      quantile(0.9), quantile(0.99), static_cast<long long>(latency.largest_us()));
}

}  // namespace

int run_daemon(const Config& config) {
  const Descriptor stop = stop_signal();
  // First of all, so that it inherits neither lines nor priority.
  Guard guard(config);
  ClosedLoopSettings<float> column;
  column.wheel.friction_nm = static_cast<float>(config.wheel_friction_nm);
  Task task(kSteeringWheel<float>, InputSupervision::kSteeringWheel, Probe::kGentle, column);
  restore(config, task);
  WatchedBoard board(config, stop.number(), guard, task);
  const std::string refused = linux_gpiod::become_realtime(config.priority);
  if (!refused.empty()) log(Level::kWarning, "running without real-time guarantees: %s", refused.c_str());
  log(Level::kInfo, "running on %s, ticks by %s", config.can.c_str(), config.lines.sample_ready ? "edges" : "timer");
  const Status end = run_loop(board, task);
  board.make_safe();
  Notify().tell("STOPPING=1");
  if (end != Status::kOk) {
    log(Level::kError,
        board.guarded() ? "the loop ended: %s" : "the guard process is gone or stands still (%s); outputs are safe",
        name(end));
    return 3;
  }
  board.save();
  say_how_it_went(board);
  log(Level::kInfo, "stopped as asked");
  return 0;
}

void dry_run(const Config& config) {
  const Descriptor stop = stop_signal();
  const Board board(config.lines, CanSocket(config.can), stop.number());
  if (!config.state_file.empty()) const StateFile file(config.state_file);
  log(Level::kInfo, "the config is good: CAN interface, lines and state file are there");
}

}  // namespace steerid::linux_ecu
