// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "linux_gpiod/board.hpp"

#include <algorithm>

namespace steerid::linux_gpiod {
namespace {

template <class Line, class... Level>
std::optional<Line> wired(const std::optional<LineConfig>& config, Level... level) {
  if (!config) return std::nullopt;
  return Line(*config, level...);
}

}  // namespace

Board::Board(const BoardLines& lines, CanSocket can, int stop)
    : sample_ready_(wired<EdgeLine>(lines.sample_ready)),
      probe_enable_(wired<InputLine>(lines.probe_enable)),
      valid_{.line = wired<OutputLine>(lines.valid, false), .level = false},
      fault_{.line = wired<OutputLine>(lines.fault, true), .level = true},
      heartbeat_{.line = wired<OutputLine>(lines.heartbeat, false), .level = false},
      can_(std::move(can)),
      tick_(sample_ready_ ? &*sample_ready_ : nullptr, stop) {}

void Board::drive(Output& output, bool level) {
  if (!output.line || output.level == level) return;
  if (output.line->set(level) == Status::kOk) {
    output.level = level;
  } else {
    ++counters_.line_failed;
  }
}

void Board::make_safe() {
  drive(valid_, false);
  drive(fault_, true);
  drive(heartbeat_, false);
}

Status Board::wait_tick() {
  const Status status = tick_.wait();
  if (status == Status::kEndOfStream) return status;
  if (probe_enable_ && probe_enable_->read(probe_enabled_) != Status::kOk) {
    probe_enabled_ = false;
    ++counters_.line_failed;
  }
  if (status != Status::kIoError) return status;
  ++counters_.line_failed;
  return Status::kLate;  // the tick goes on by the timer
}

void Board::receive() {
  can::Frame frame;
  Sample sample;
  while (can_.read(frame) == Status::kOk) {
    if (assembly_.take(frame, sample) != Status::kOk) continue;
    if (queued_ == kQueue) {
      counters_.dropped += kQueue;
      queued_ = 0;
    }
    queue_[queued_++] = sample;
  }
}

Status Board::read_sample(Sample& sample) {
  receive();
  if (queued_ == 0) return Status::kNoData;
  sample = queue_[0];
  std::move(queue_.begin() + 1, queue_.begin() + static_cast<std::ptrdiff_t>(queued_), queue_.begin());
  --queued_;
  ++counters_.samples;
  return Status::kOk;
}

void Board::send(const can::Frame& frame, bool& failed) {
  if (can_.write(frame) != Status::kOk) failed = true;
}

Status Board::publish(const Estimate& estimate) {
  bool failed = false;
  for (const can::Frame& frame : messages_.next(estimate, assembly_.counters())) send(frame, failed);
  can_works_ = !failed;
  counters_.send_failed += failed ? 1 : 0;
  return failed ? Status::kIoError : Status::kOk;
}

Status Board::request_probe_torque(std::int32_t torque_mnm) {
  bool failed = false;
  send(can::probe_request(torque_mnm, probe_alive_), failed);
  probe_alive_ = can::next_alive(probe_alive_);
  return failed ? Status::kIoError : Status::kOk;
}

void Board::kick_watchdog() {
  drive(heartbeat_, !heartbeat_.level);
  latency_.add(monotonic_ns() - tick_.due_ns());
}

}  // namespace steerid::linux_gpiod
