// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One classic CAN frame with an 11 bit identifier, and the fields ("signals") in its payload.
//
// Signals lie as a DBC file says for Intel byte order: `start` is the number of the lowest bit, bit 0 being the least
// significant bit of byte 0. No float, no allocation; a payload is handled as one 64 bit word.
#pragma once

#include <array>
#include <cstdint>

namespace steerid::can {

struct Frame {
  std::uint16_t id = 0;
  std::uint8_t length = 8;  ///< bytes of `data` that count, 0 to 8
  std::array<std::uint8_t, 8> data{};

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// Where a number lies in a payload. start + length <= 64, length >= 1.
struct Signal {
  std::uint8_t start = 0;
  std::uint8_t length = 1;
  bool is_signed = false;

  [[nodiscard]] constexpr std::uint64_t mask() const {
    return length >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << length) - 1U;
  }
  [[nodiscard]] constexpr std::int64_t lowest() const {
    return is_signed ? -(std::int64_t{1} << (length - 1U)) : std::int64_t{0};
  }
  [[nodiscard]] constexpr std::int64_t highest() const {
    return static_cast<std::int64_t>(mask() >> (is_signed ? 1U : 0U));
  }
};

constexpr std::uint64_t word(const Frame& frame) {
  std::uint64_t all = 0;
  for (unsigned i = 0; i < 8U; ++i) all |= static_cast<std::uint64_t>(frame.data[i]) << (8U * i);
  return all;
}

/// Writes `value`, held at the ends of the signal's range: a bus must not wrap a large torque into a small one.
constexpr void put(Frame& frame, const Signal& signal, std::int64_t value) {
  if (value < signal.lowest()) value = signal.lowest();
  if (value > signal.highest()) value = signal.highest();
  std::uint64_t all = word(frame) & ~(signal.mask() << signal.start);
  all |= (static_cast<std::uint64_t>(value) & signal.mask()) << signal.start;
  for (unsigned i = 0; i < 8U; ++i) frame.data[i] = static_cast<std::uint8_t>(all >> (8U * i));
}

constexpr std::int64_t get(const Frame& frame, const Signal& signal) {
  const std::uint64_t raw = (word(frame) >> signal.start) & signal.mask();
  const bool negative = signal.is_signed && ((raw >> (signal.length - 1U)) & 1U) != 0U;
  return static_cast<std::int64_t>(negative ? raw | ~signal.mask() : raw);
}

}  // namespace steerid::can
