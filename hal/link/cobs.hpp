// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Consistent Overhead Byte Stuffing (Cheshire and Baker, 1999): bytes without any zero, so that a zero can end a frame.
// Whatever garbage a receiver has seen, it is in step again at the next zero.
//
// A block is a code byte n = 1 to 255 and n - 1 bytes that are not zero; behind every block but the last stands a zero
// in the decoded data, unless n is 255. Up to 254 bytes grow by one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace steerid::link {

/// Encodes up to 254 bytes; `into` holds one more. Returns the length, without a final zero.
constexpr std::size_t cobs_encode(std::span<const std::uint8_t> data, std::span<std::uint8_t> into) {
  std::size_t code_at = 0;
  std::size_t length = 1;
  for (const std::uint8_t byte : data) {
    if (byte != 0) {
      into[length++] = byte;
    } else {
      into[code_at] = static_cast<std::uint8_t>(length - code_at);
      code_at = length++;
    }
  }
  into[code_at] = static_cast<std::uint8_t>(length - code_at);
  return length;
}

/// Decodes in place what stood before a zero. Returns the length of the data; 0 when it is no encoding, or of nothing.
constexpr std::size_t cobs_decode(std::span<std::uint8_t> bytes) {
  std::size_t length = 0;
  std::size_t at = 0;
  while (at < bytes.size()) {
    const std::size_t end = at + bytes[at];
    if (bytes[at] == 0 || end > bytes.size()) return 0;
    const bool zero_behind = bytes[at] != 255 && end < bytes.size();
    for (++at; at < end; ++at) bytes[length++] = bytes[at];
    if (zero_behind) bytes[length++] = 0;
  }
  return length;
}

}  // namespace steerid::link
