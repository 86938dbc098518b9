// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// CRC-32 of IEEE 802.3: reflected polynomial 0xEDB88320, start and final xor 0xFFFFFFFF; "123456789" gives CBF43926.
//
// Finds every burst of up to 32 bits, and every error of up to 5 bits in up to 268 bits of data, of up to 4 in up to
// 2974 (Koopman 2002). Anything else passes with a probability of 2^-32.
//
// Cost: two look-ups a byte in a table of 64 bytes, about 11 instructions a byte on a Cortex-M.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace steerid {

namespace crc32_detail {

constexpr std::array<std::uint32_t, 16> table() {
  std::array<std::uint32_t, 16> rows{};
  for (std::uint32_t i = 0; i < 16; ++i) {
    std::uint32_t row = i;
    for (int bit = 0; bit < 4; ++bit) row = (row >> 1U) ^ ((row & 1U) != 0U ? 0xEDB88320U : 0U);
    rows[i] = row;
  }
  return rows;
}
inline constexpr std::array<std::uint32_t, 16> kTable = table();

}  // namespace crc32_detail

constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  using crc32_detail::kTable;
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc = kTable[(crc ^ byte) & 0xFU] ^ (crc >> 4U);
    crc = kTable[(crc ^ (static_cast<std::uint32_t>(byte) >> 4U)) & 0xFU] ^ (crc >> 4U);
  }
  return ~crc;
}

}  // namespace steerid
