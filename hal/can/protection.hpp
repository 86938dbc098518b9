// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What shows a receiver that a frame is damaged, foreign, repeated or lost: a checksum and an alive counter, in every
// message at the same place.
//
// | signal       | bits    |                                                                                      |
// | Checksum     | 0 to 7  | CRC-8/AUTOSAR (polynomial 0x2F, start and final xor 0xFF) over the identifier's low  |
// |              |         | and high byte, then payload bytes 1 to 7. With the identifier in it, a frame that a  |
// |              |         | gateway puts under another identifier does not pass                                  |
// | AliveCounter | 8 to 11 | 0 to 14, one more with each cycle, then 0 again; 15 is never sent                    |
//
// They are no authentication. Both find what goes wrong by itself, and anyone who may write on the bus can compute
// both; what an assembly of samples does about forged frames, and what it cannot, is said in sample_messages.hpp and in
// docs/linux_ecu.md.
//
// The polynomial has Hamming distance 4 up to 119 bits of data (Koopman and Chakravarty, 2004), where the older 0x1D of
// SAE J1850 has 3: the checksum finds every error of up to 3 bits in these 72 and 8, and every burst of up to 8. The
// frame's own CRC-15 stands before it on the wire; this one is end to end.
#pragma once

#include <cstdint>

#include "can/frame.hpp"

namespace steerid::can {

inline constexpr Signal kChecksum{.start = 0, .length = 8};
inline constexpr Signal kAliveCounter{.start = 8, .length = 4};
inline constexpr std::uint8_t kAliveCycle = 15;  ///< values of the alive counter

constexpr std::uint8_t crc8_2f_byte(std::uint8_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint8_t>(crc ^ byte);
  for (int bit = 0; bit < 8; ++bit) {
    const bool high = (crc & 0x80U) != 0U;
    crc = static_cast<std::uint8_t>((crc << 1U) ^ (high ? 0x2FU : 0U));
  }
  return crc;
}

constexpr std::uint8_t checksum(const Frame& frame) {
  std::uint8_t crc = 0xFF;
  crc = crc8_2f_byte(crc, static_cast<std::uint8_t>(frame.id));
  crc = crc8_2f_byte(crc, static_cast<std::uint8_t>(frame.id >> 8U));
  for (std::size_t i = 1; i < frame.data.size(); ++i) crc = crc8_2f_byte(crc, frame.data[i]);
  return static_cast<std::uint8_t>(crc ^ 0xFFU);
}

/// The counter after `alive`.
constexpr std::uint8_t next_alive(std::uint8_t alive) {
  return alive + 1 >= kAliveCycle ? std::uint8_t{0} : static_cast<std::uint8_t>(alive + 1);
}

/// Writes counter and checksum; every other signal must be in place already.
constexpr void protect(Frame& frame, std::uint8_t alive) {
  put(frame, kAliveCounter, alive);
  frame.data[0] = checksum(frame);
}

/// Whole length, checksum right and a counter that a sender of ours can send.
constexpr bool intact(const Frame& frame) {
  return frame.length == 8 && frame.data[0] == checksum(frame) && get(frame, kAliveCounter) < kAliveCycle;
}

}  // namespace steerid::can
