// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What reader and writer of MCAP have in common: the first bytes and the records' kinds, https://mcap.dev/spec.
#pragma once

#include <cstdint>
#include <string_view>

namespace steerid::mcap {

inline constexpr std::string_view kMagic = "\x89MCAP0\r\n";

enum Kind : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

}  // namespace steerid::mcap
