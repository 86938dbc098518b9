// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Frames: what turns a message into bytes on a wire that may lose, damage or invent any of them, and back.
//
//   frame   COBS(version u8, type u8, sequence u16, payload, CRC-32 u32 over all before), 0x00
//
// All little endian. The sequence counts the frames of one direction and wraps; a gap tells the receiver how many were
// lost. A receiver turns down what is too long, no COBS encoding, or wrong by its CRC (damaged), and what is of another
// version (foreign). After any garbage it is in step again behind the next zero.
//
// What gets through: with a damaged frame the CRC's promise (base/crc32.hpp) holds for errors between the delimiters
// that leave the encoding's code bytes alone. An error that makes or hits a code byte or a delimiter shifts bytes, and
// is one of the many that pass with a probability of 2^-32.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/crc32.hpp"
#include "link/cobs.hpp"
#include "link/messages.hpp"

namespace steerid::link {

inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::size_t kHeader = 4;
inline constexpr std::size_t kOverhead = kHeader + 4;                    ///< of a packet, with its CRC
inline constexpr std::size_t kMostFrame = kMostPayload + kOverhead + 2;  ///< with code byte and final zero

/// One direction's frames, numbered. The span is valid until the next call.
class FrameWriter {
 public:
  constexpr std::span<const std::uint8_t> frame(Type type, std::span<const std::uint8_t> payload = {}) {
    std::array<std::uint8_t, kMostPayload + kOverhead> packet{};
    packet[0] = kVersion;
    packet[1] = static_cast<std::uint8_t>(type);
    packet[2] = static_cast<std::uint8_t>(sequence_);
    packet[3] = static_cast<std::uint8_t>(sequence_ >> 8U);
    ++sequence_;
    std::size_t length = kHeader;
    for (const std::uint8_t byte : payload) packet[length++] = byte;
    const std::uint32_t crc = crc32(std::span(packet).first(length));
    for (std::size_t i = 0; i < 4; ++i) packet[length++] = static_cast<std::uint8_t>(crc >> (8U * i));
    length = cobs_encode(std::span(packet).first(length), frame_);
    frame_[length++] = 0;
    return std::span(frame_).first(length);
  }
  template <class Message>
  constexpr std::span<const std::uint8_t> frame(Type type, const Message& message) {
    return frame(type, payload(message).bytes());
  }

 private:
  std::array<std::uint8_t, kMostFrame> frame_{};
  std::uint16_t sequence_ = 0;
};

/// Takes in one byte after the other. Cost: a store a byte, and the check at a frame's end.
class FrameReader {
 public:
  /// True when `byte` ends a good frame, which type(), sequence() and payload() then describe until the next call.
  constexpr bool push(std::uint8_t byte) {
    if (byte != 0) {
      if (length_ < bytes_.size()) bytes_[length_] = byte;
      ++length_;
      if (length_ > bytes_.size()) length_ = bytes_.size() + 1;
      return false;
    }
    const std::size_t encoded = length_;
    length_ = 0;
    if (encoded == 0) return false;  // zeros between frames are allowed, to wake a receiver up
    return accept(encoded);
  }

  [[nodiscard]] constexpr Type type() const { return static_cast<Type>(bytes_[1]); }
  [[nodiscard]] constexpr std::uint16_t sequence() const {
    return static_cast<std::uint16_t>(bytes_[2] | static_cast<unsigned>(bytes_[3]) << 8U);
  }
  [[nodiscard]] constexpr std::span<const std::uint8_t> payload() const {
    return std::span(bytes_).subspan(kHeader, payload_);
  }

  [[nodiscard]] constexpr std::uint32_t damaged() const { return damaged_; }
  [[nodiscard]] constexpr std::uint32_t foreign() const { return foreign_; }
  /// Frames of the sender that never came, by its sequence numbers.
  [[nodiscard]] constexpr std::uint32_t lost() const { return lost_; }
  /// The sender starts again: the next frame's number is where counting begins.
  constexpr void forget_sequence() { any_ = false; }

 private:
  constexpr bool accept(std::size_t encoded) {
    const std::size_t packet = encoded > bytes_.size() ? 0 : cobs_decode(std::span(bytes_).first(encoded));
    if (packet < kOverhead) return refuse(damaged_);
    std::uint32_t crc = 0;
    for (std::size_t i = 0; i < 4; ++i) crc |= static_cast<std::uint32_t>(bytes_[packet - 4 + i]) << (8U * i);
    if (crc != crc32(std::span(bytes_).first(packet - 4))) return refuse(damaged_);
    if (bytes_[0] != kVersion) return refuse(foreign_);
    payload_ = packet - kOverhead;
    const auto gap = static_cast<std::uint16_t>(sequence() - last_ - 1U);
    if (any_ && gap < 0x8000U) lost_ += gap;  // more is a step back: a frame again, or a sender that started again
    any_ = true;
    last_ = sequence();
    return true;
  }
  static constexpr bool refuse(std::uint32_t& counter) {
    if (counter < UINT32_MAX) ++counter;
    return false;
  }

  std::array<std::uint8_t, kMostFrame - 1> bytes_{};
  std::size_t length_ = 0;  ///< one beyond the room stands for too many
  std::size_t payload_ = 0;
  std::uint32_t damaged_ = 0;
  std::uint32_t foreign_ = 0;
  std::uint32_t lost_ = 0;
  std::uint16_t last_ = 0;
  bool any_ = false;
};

}  // namespace steerid::link
