// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The encodings that text files come in, brought to UTF-8.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace steerid {

enum class Encoding : std::uint8_t { kUtf8, kUtf16Little, kUtf16Big };

/// By the byte-order mark, or by which of a text's first bytes are zero; kUtf8 for everything else.
[[nodiscard]] Encoding encoding_of(std::string_view first_bytes);

[[nodiscard]] bool is_utf8(std::string_view text);

/// Takes what can be converted out of `bytes`; an odd last byte stays. `surrogate` keeps the first half of a pair that
/// the end cuts, and is 0 at first. The byte-order mark is converted too; what is no character becomes U+FFFD.
[[nodiscard]] std::string utf8_of_utf16(std::vector<char>& bytes, Encoding encoding, char16_t& surrogate);

/// A whole text, which stays as it is unless it is UTF-16.
[[nodiscard]] std::string utf8_of(std::string text);

/// Of Windows-1252, which is Latin-1 but for 0x80 to 0x9f; the five bytes it leaves open stay the control characters
/// that Latin-1 has there.
[[nodiscard]] std::string utf8_of_windows_1252(std::string_view text);

}  // namespace steerid
