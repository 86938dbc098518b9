// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The port on a board at the end of the link (link/frame.hpp): sensor frames in, estimates out, ticks from the board's
// timer or from the link, and a watch on the deadlines.
//
//   started   by a start message. Until then the board answers hello and reset, and sleeps.
//   late      a tick that begins when the next one is already due; wait_tick() returns kLate
//   missed    a tick that never began
//   overrun   a step, from wait_tick() to kick_watchdog(), that takes longer than a period
//   watchdog  runs once a drive has started that the board's timer paces. It is kicked in
//             kick_watchdog() and nowhere else. A drive that the link paces has no watchdog,
//             because it has no time of its own.
//
// Late, missed and overrun ticks are counted; the health message publishes the counters every 100 ticks.
//
// Cost beside the loop: one frame a tick to encode and one to decode, some 25 instructions a byte.
#pragma once

#include <cstdint>

#include "base/status.hpp"
#include "ecu/peripherals.hpp"
#include "link/frame.hpp"
#include "port/port.hpp"

namespace steerid {

template <Peripherals Board>
class LinkedEcu {
 public:
  explicit LinkedEcu(Board& board) : board_(&board) { greet(); }

  Status wait_tick() {
    for (;;) {
      const bool tick = listen();
      if (!started_) {
        board_->sleep();
        continue;
      }
      if (pace_ == link::Pace::kLink) {
        // Where the link paces, the step waits for its answer's room: no estimate is lost.
        if (tick) {
          while (!board_->can_send()) board_->sleep();
          return begin_step(1);
        }
      } else {
        const std::uint32_t elapsed = board_->timer_ticks() - last_tick_;
        if (elapsed > 0) {
          last_tick_ += elapsed;
          return begin_step(elapsed);
        }
      }
      board_->sleep();
    }
  }

  Status read_sample(Sample& sample) {
    if (!fresh_) return Status::kNoData;
    fresh_ = false;
    sample = sample_;
    return Status::kOk;
  }

  // A call of its own, as are those below: the bytes of a frame are not to stay on the loop's stack while it
  // identifies.
  [[gnu::noinline]] Status publish(const Estimate& estimate) {
    return board_->send(writer_.frame(link::Type::kEstimate, estimate)) ? Status::kOk : Status::kIoError;
  }

  /// The link carries no probe: what streams samples has recorded or simulated them without.
  Status request_probe_torque(std::int32_t torque_mnm) { return torque_mnm == 0 ? Status::kOk : Status::kOutOfRange; }
  void set_valid(bool level) { health_.valid_line = level ? 1 : 0; }
  void set_fault(bool level) {
    health_.fault_line = level ? 1 : 0;
    board_->set_lines(health_.valid_line != 0, level);
  }

  void kick_watchdog() {
    const std::uint32_t step_us = board_->stopwatch_us();
    if (step_us > health_.longest_step_us) health_.longest_step_us = step_us;
    if (step_us > kTickPeriodUs) count(health_.overrun);
    board_->kick_watchdog();
    count(health_.ticks);
    if (health_.ticks % kHealthTicks == 0) publish_health();
  }

  static constexpr std::uint32_t kHealthTicks = 100;

 private:
  [[gnu::noinline]] void publish_health() {
    health_.frames_damaged = reader_.damaged();
    health_.frames_foreign = reader_.foreign() + unknown_;
    health_.frames_lost = reader_.lost();
    health_.overflows = board_->overflows();
    // One that does not fit is old by the next hundred ticks.
    static_cast<void>(board_->send(writer_.frame(link::Type::kHealth, health_)));
  }

  [[gnu::noinline]] void greet() {
    static_cast<void>(board_->send(writer_.frame(link::Type::kHello, board_->identity())));
  }

  /// Takes in what has arrived; true when it holds a tick of the link's pace, behind which it stops.
  bool listen() {
    std::uint8_t byte = 0;
    while (board_->receive(byte)) {
      if (reader_.push(byte) && obey()) return true;
    }
    return false;
  }

  [[gnu::noinline]] bool obey() {
    switch (reader_.type()) {
      case link::Type::kHello:
        greet();
        return false;
      case link::Type::kStart: {
        link::Start start;
        if (!link::read_payload(reader_.payload(), start)) break;
        begin_drive(start);
        return false;
      }
      case link::Type::kSample:
        if (!link::read_payload(reader_.payload(), sample_)) break;
        fresh_ = true;
        return pace_ == link::Pace::kLink && started_;
      case link::Type::kTick:
        if (!reader_.payload().empty()) break;
        return pace_ == link::Pace::kLink && started_;
      case link::Type::kReset: {
        link::Reset reset;
        if (!link::read_payload(reader_.payload(), reset)) break;
        board_->reset(reset.keep_saved != 0);
        return false;
      }
      case link::Type::kEstimate:
      case link::Type::kHealth:
        break;
    }
    count(unknown_);
    return false;
  }

  void begin_drive(const link::Start& start) {
    pace_ = start.pace;
    started_ = true;
    fresh_ = false;
    health_ = {};
    static_cast<void>(board_->send(writer_.frame(link::Type::kStart, start)));
    const bool timed = pace_ == link::Pace::kTimer;
    board_->run_timer(timed);
    last_tick_ = board_->timer_ticks();
    if (timed) board_->start_watchdog();
  }

  Status begin_step(std::uint32_t elapsed) {
    board_->start_stopwatch();
    if (elapsed == 1) return Status::kOk;
    count(health_.late);
    health_.missed += elapsed - 1;
    return Status::kLate;
  }

  static void count(std::uint32_t& counter) {
    if (counter < UINT32_MAX) ++counter;
  }

  Board* board_;
  link::FrameReader reader_;
  link::FrameWriter writer_;
  link::Health health_;
  Sample sample_;
  std::uint32_t last_tick_ = 0;
  std::uint32_t unknown_ = 0;
  link::Pace pace_ = link::Pace::kTimer;
  bool started_ = false;
  bool fresh_ = false;
};

}  // namespace steerid
