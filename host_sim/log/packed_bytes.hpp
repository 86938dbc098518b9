// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Blocks of bytes as MCAP packs them: "lz4" (its frame format), "zstd", or "" for not at all.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace steerid {

/// Nothing where the method is none of the three, or what comes out has not `size` bytes. Memory grows with what comes
/// out, never by what is only promised.
[[nodiscard]] std::optional<std::string> unpacked(std::string_view method, std::string_view packed, std::uint64_t size);

[[nodiscard]] std::string packed_by_zstd(std::string_view bytes);

/// The CRC-32 of zlib, PNG and MCAP, carried on from `before`.
[[nodiscard]] std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace steerid
