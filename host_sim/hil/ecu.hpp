// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// An ECU at the other end of a line: the handshake, frames out, frames in, and how to make the line worse than it is.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>

#include "hil/byte_channel.hpp"
#include "link/frame.hpp"

namespace steerid::hil {

class Ecu {
 public:
  /// Waits for the ECU's hello, asking for it once in a while. Throws BadInput when none comes within 20 s.
  explicit Ecu(ByteChannel channel);

  [[nodiscard]] const link::Identity& identity() const { return identity_; }

  void start(link::Pace pace);
  void sample(const Sample& sample) { channel_.write(writer_.frame(link::Type::kSample, sample)); }
  void tick() { channel_.write(writer_.frame(link::Type::kTick)); }
  /// A sample that does not arrive whole: one to three bits wrong, never the frame's end.
  void damaged_sample(const Sample& sample, std::mt19937_64& random);
  /// A sample that does not arrive at all.
  void lost_sample(const Sample& sample) { static_cast<void>(writer_.frame(link::Type::kSample, sample)); }
  /// Resets the ECU and waits until it is there again.
  void reset(bool keep_saved);
  /// It has started again by itself since start(): its watchdog, or its supply. identity() says which.
  [[nodiscard]] bool started_again() const { return started_again_; }

  /// The next estimate. Throws BadInput when none comes within 20 s, when the ECU has started again instead, or when a
  /// frame of its is missing: nobody knows which.
  Estimate estimate();
  /// An estimate that is there already.
  std::optional<Estimate> estimate_if_any(int timeout_ms);
  [[nodiscard]] const link::Health& health() const { return health_; }
  /// Frames that this end turned down.
  [[nodiscard]] std::uint32_t damaged() const { return reader_.damaged(); }

 private:
  static constexpr int kPatienceMs = 20'000;

  bool listen(int timeout_ms);
  void take(link::Type type);
  Estimate pop();
  void meet();

  ByteChannel channel_;
  link::FrameWriter writer_;
  link::FrameReader reader_;
  link::Identity identity_;
  link::Health health_;
  std::deque<Estimate> estimates_;
  std::size_t good_ = 0;           ///< frames since it was last asked who it is
  std::uint32_t lost_before_ = 0;  ///< frames that were lost before the drive: a board that starts again counts anew
  bool met_ = false;
  bool started_ = false;
  bool started_again_ = false;
};

}  // namespace steerid::hil
