// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The port on an embedded Linux box beside the EPS: samples and estimates over SocketCAN, three lines out, two lines
// in.
//
//   sample_ready  in   an edge when a sample's messages are on the bus: the tick; a 10 ms timer where it is not wired
//   probe_enable  in   active: the EPS permits a probe; not wired: never
//   valid         out  all three parameters are valid
//   fault         out  the input is faulty, or estimates cannot be sent
//   heartbeat     out  changes with every tick that went through the whole loop
//
// Safe levels: valid inactive, fault active, heartbeat still. The outputs have them before the first tick, and again
// when this object goes.
//
// Samples wait in a queue of kQueue. One is handed out a tick, so that sender and receiver may drift against each other
// by a tick without a loss; when the queue overflows, the newest is kept and the others are counted as `dropped`.
//
// Nothing here allocates or blocks after construction, wait_tick() apart.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/status.hpp"
#include "can/estimate_messages.hpp"
#include "can/sample_messages.hpp"
#include "linux_gpiod/can_socket.hpp"
#include "linux_gpiod/distribution.hpp"
#include "linux_gpiod/gpio_line.hpp"
#include "linux_gpiod/tick.hpp"
#include "port/port.hpp"

namespace steerid::linux_gpiod {

/// Lines that are absent are not wired.
struct BoardLines {
  std::optional<LineConfig> sample_ready;
  std::optional<LineConfig> probe_enable;
  std::optional<LineConfig> valid;
  std::optional<LineConfig> fault;
  std::optional<LineConfig> heartbeat;
};

struct BoardCounters {
  std::uint64_t samples = 0;
  std::uint64_t dropped = 0;      ///< samples that came faster than the ticks
  std::uint64_t send_failed = 0;  ///< ticks with a frame that could not be sent
  std::uint64_t line_failed = 0;  ///< times a line could not be set or read
};

class Board {
 public:
  static constexpr std::size_t kQueue = 3;

  /// `stop` becomes readable when the loop has to end. Throws Failure when a line cannot be had.
  Board(const BoardLines& lines, CanSocket can, int stop);
  ~Board() { make_safe(); }
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  Status wait_tick();
  Status read_sample(Sample& sample);
  Status publish(const Estimate& estimate);
  Status request_probe_torque(std::int32_t torque_mnm);
  void set_valid(bool level) { drive(valid_, level); }
  void set_fault(bool level) { drive(fault_, level); }
  /// Changes the heartbeat.
  void kick_watchdog();

  /// Drives the safe levels.
  void make_safe();

  [[nodiscard]] bool probe_enabled() const { return probe_enabled_; }
  /// False from the first frame that could not be sent until one can be sent again.
  [[nodiscard]] bool can_works() const { return can_works_; }
  [[nodiscard]] bool lines_work() const { return counters_.line_failed == 0; }

  [[nodiscard]] const BoardCounters& counters() const { return counters_; }
  [[nodiscard]] const TickCounters& tick_counters() const { return tick_.counters(); }
  /// False while samples contradict each other (can/sample_messages.hpp).
  [[nodiscard]] bool samples_agree() const { return assembly_.accepts(); }
  [[nodiscard]] const can::SampleCounters& sample_counters() const { return assembly_.counters(); }
  /// From the moment a tick was due (the edge's own stamp) to the change of the heartbeat.
  [[nodiscard]] const Distribution& latency() const { return latency_; }

 private:
  struct Output {
    std::optional<OutputLine> line;
    bool level = false;
  };

  void drive(Output& output, bool level);
  void receive();
  void send(const can::Frame& frame, bool& failed);

  std::optional<EdgeLine> sample_ready_;
  std::optional<InputLine> probe_enable_;
  Output valid_;
  Output fault_;
  Output heartbeat_;
  CanSocket can_;
  Tick tick_;

  can::SampleAssembly assembly_;
  std::array<Sample, kQueue> queue_{};
  std::size_t queued_ = 0;
  can::EstimateMessages messages_;
  std::uint8_t probe_alive_ = 0;
  bool probe_enabled_ = false;
  bool can_works_ = true;
  BoardCounters counters_;
  Distribution latency_;
};

static_assert(Hal<Board>);

}  // namespace steerid::linux_gpiod
