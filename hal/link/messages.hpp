// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The messages of the link and their bytes: integers only, little endian, in the order of the fields() below, which
// both directions share. docs/link_protocol.md has the tables and examples.
//
//   type        direction  meaning
//   kHello      both       host: who is there? (empty)   ECU: Identity; also unasked, once after its start
//   kStart      host, ECU  begins a drive: Start; the ECU repeats it as its answer
//   kSample     host, ECU  a sample for this tick; bar, rim and probe follow where one of their valid bits is set
//   kTick       host, ECU  a tick without a sample (empty); only where the link paces
//   kReset      host, ECU  reset yourself: Reset
//   kEstimate   ECU, host  what the task published
//   kHealth     ECU, host  Health, every 100 ticks
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "port/estimate.hpp"
#include "port/sample.hpp"

namespace steerid::link {

enum class Type : std::uint8_t {
  kHello = 0x01,
  kStart = 0x02,
  kSample = 0x03,
  kTick = 0x04,
  kReset = 0x05,
  kEstimate = 0x11,
  kHealth = 0x12,
};

enum class Board : std::uint8_t { kMps2An386 = 1, kMps2An385 = 2 };
enum class Number : std::uint8_t { kFloat = 0, kFixed = 1 };
enum class ResetCause : std::uint8_t { kPowerOn = 0, kWatchdog = 1, kRequested = 2 };
/// What makes a tick.
enum class Pace : std::uint8_t {
  kTimer = 0,  ///< the board's 100 Hz timer
  kLink = 1,   ///< the arrival of a sample or tick message: as fast as both ends can
};

struct Identity {
  Board board = Board::kMps2An386;
  Number number = Number::kFloat;
  ResetCause cause = ResetCause::kPowerOn;
  std::uint8_t restored = 0;  ///< 1: the task goes on from a saved estimate
};

struct Start {
  Pace pace = Pace::kTimer;
};

struct Reset {
  std::uint8_t keep_saved = 1;  ///< 0: forget the saved estimate, too
};

/// The board's supervision of itself since its start; counters stop at their ends.
struct Health {
  std::uint32_t ticks = 0;
  std::uint32_t late = 0;             ///< ticks that began after the next one was due
  std::uint32_t missed = 0;           ///< ticks that never began
  std::uint32_t overrun = 0;          ///< steps that took longer than a period
  std::uint32_t longest_step_us = 0;  ///< from tick to watchdog kick
  std::uint32_t frames_damaged = 0;   ///< refused by their length, encoding or CRC
  std::uint32_t frames_foreign = 0;   ///< of another version, or of no known type and length
  std::uint32_t frames_lost = 0;      ///< gaps in the sequence numbers
  std::uint32_t overflows = 0;        ///< of the fixed-point arithmetic; 0 in float
  std::uint8_t valid_line = 0;
  std::uint8_t fault_line = 0;
};

/// The order of the bytes, once for both directions: `wire` writes or reads each field that it is given.
template <class Wire, class Message>
constexpr void fields(Wire& wire, Message& m) {
  using Plain = std::remove_const_t<Message>;
  if constexpr (std::same_as<Plain, Sample>) {
    wire(m.stamp_us), wire(m.angle_urad), wire(m.torque_driver_mnm), wire(m.torque_motor_mnm);
    wire(m.sequence), wire(m.valid_bits);
    if ((m.valid_bits & kColumnChannels) != 0) wire(m.torque_bar_mnm), wire(m.torque_rim_mnm), wire(m.probe_mnm);
  } else if constexpr (std::same_as<Plain, ParameterEstimate>) {
    wire(m.value_micro), wire(m.sd_micro), wire(m.state, ParameterState::kNotExcited);
  } else if constexpr (std::same_as<Plain, InputCounters>) {
    wire(m.accepted_after_gap), wire(m.invalid_channel), wire(m.out_of_range), wire(m.spike);
    wire(m.stuck), wire(m.repeated), wire(m.out_of_order), wire(m.late_tick);
  } else if constexpr (std::same_as<Plain, Estimate>) {
    wire(m.stamp_us);
    fields(wire, m.inertia), fields(wire, m.damping), fields(wire, m.stiffness);
    wire(m.driver, DriverState::kBraced), wire(m.hands, HandCount::kTwo);
    fields(wire, m.counters);
  } else if constexpr (std::same_as<Plain, Identity>) {
    wire(m.board, Board::kMps2An385), wire(m.number, Number::kFixed);
    wire(m.cause, ResetCause::kRequested), wire(m.restored);
  } else if constexpr (std::same_as<Plain, Start>) {
    wire(m.pace, Pace::kLink);
  } else if constexpr (std::same_as<Plain, Reset>) {
    wire(m.keep_saved);
  } else {
    static_assert(std::same_as<Plain, Health>);
    wire(m.ticks), wire(m.late), wire(m.missed), wire(m.overrun), wire(m.longest_step_us);
    wire(m.frames_damaged), wire(m.frames_foreign), wire(m.frames_lost), wire(m.overflows);
    wire(m.valid_line), wire(m.fault_line);
  }
}

inline constexpr std::size_t kMostPayload = 64;

/// Collects the bytes of a message.
class PayloadWriter {
 public:
  template <std::integral Integer>
  constexpr void operator()(const Integer& value) {
    const auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
    for (std::size_t i = 0; i < sizeof(Integer); ++i) bytes_[length_++] = static_cast<std::uint8_t>(bits >> (8U * i));
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  constexpr void operator()(const Enum& value, Enum) { bytes_[length_++] = static_cast<std::uint8_t>(value); }
  [[nodiscard]] constexpr std::span<const std::uint8_t> bytes() const { return std::span(bytes_).first(length_); }

 private:
  std::array<std::uint8_t, kMostPayload> bytes_{};
  std::size_t length_ = 0;
};

/// Takes a message apart; good() when every byte was used and every enumeration was one of its values.
class PayloadReader {
 public:
  constexpr explicit PayloadReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::integral Integer>
  constexpr void operator()(Integer& value) {
    if (bytes_.size() - at_ < sizeof(Integer)) {
      good_ = false;
      return;
    }
    std::make_unsigned_t<Integer> bits = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      bits = static_cast<std::make_unsigned_t<Integer>>(bits | static_cast<std::make_unsigned_t<Integer>>(bytes_[at_++])
                                                                   << (8U * i));
    }
    value = static_cast<Integer>(bits);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  constexpr void operator()(Enum& value, Enum last) {
    std::uint8_t byte = 0;
    (*this)(byte);
    if (byte > static_cast<std::uint8_t>(last)) good_ = false;
    value = static_cast<Enum>(byte);
  }
  [[nodiscard]] constexpr bool good() const { return good_ && at_ == bytes_.size(); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

template <class Message>
constexpr PayloadWriter payload(const Message& message) {
  PayloadWriter writer;
  fields(writer, message);
  return writer;
}

/// False, and `message` unchanged, when the bytes are no such message.
template <class Message>
constexpr bool read_payload(std::span<const std::uint8_t> bytes, Message& message) {
  Message read;
  PayloadReader reader(bytes);
  fields(reader, read);
  if (reader.good()) message = read;
  return reader.good();
}

}  // namespace steerid::link
