// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/text_encoding.hpp"

#include <algorithm>
#include <array>

namespace steerid {
namespace {

void append_utf8(std::string& out, char32_t point) {
  const auto tail = [&](unsigned shift) { out += static_cast<char>(0x80U | ((point >> shift) & 0x3fU)); };
  if (point < 0x80) {
    out += static_cast<char>(point);
  } else if (point < 0x800) {
    out += static_cast<char>(0xc0U | (point >> 6U));
    tail(0);
  } else if (point < 0x10000) {
    out += static_cast<char>(0xe0U | (point >> 12U));
    tail(6);
    tail(0);
  } else {
    out += static_cast<char>(0xf0U | (point >> 18U));
    tail(12);
    tail(6);
    tail(0);
  }
}

constexpr char32_t kNoCharacter = 0xfffd;

bool is_high_surrogate(char16_t unit) { return unit >= 0xd800 && unit < 0xdc00; }
bool is_low_surrogate(char16_t unit) { return unit >= 0xdc00 && unit < 0xe000; }

}  // namespace

Encoding encoding_of(std::string_view first_bytes) {
  if (first_bytes.starts_with("\xff\xfe")) return Encoding::kUtf16Little;
  if (first_bytes.starts_with("\xfe\xff")) return Encoding::kUtf16Big;
  if (first_bytes.size() < 4) return Encoding::kUtf8;
  const auto zero = [&](std::size_t i) { return first_bytes[i] == '\0'; };
  if (!zero(0) && zero(1) && !zero(2) && zero(3)) return Encoding::kUtf16Little;
  if (zero(0) && !zero(1) && zero(2) && !zero(3)) return Encoding::kUtf16Big;
  return Encoding::kUtf8;
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    if (lead < 0x80) continue;
    const std::size_t more = lead >= 0xc2 && lead < 0xe0 ? 1 : lead >= 0xe0 && lead < 0xf0 ? 2 : lead < 0xf5 ? 3 : 0;
    if (lead < 0xc2 || more == 0 || text.size() - i <= more) return false;
    for (std::size_t j = 1; j <= more; ++j) {
      if ((static_cast<unsigned char>(text[i + j]) & 0xc0U) != 0x80U) return false;
    }
    i += more;
  }
  return true;
}

std::string utf8_of_utf16(std::vector<char>& bytes, Encoding encoding, char16_t& surrogate) {
  std::string out;
  const std::size_t high = encoding == Encoding::kUtf16Little ? 1 : 0;
  const std::size_t whole = bytes.size() / 2 * 2;
  for (std::size_t i = 0; i < whole; i += 2) {
    const auto unit = static_cast<char16_t>((static_cast<unsigned char>(bytes[i + high]) << 8U) |
                                            static_cast<unsigned char>(bytes[i + 1 - high]));
    if (surrogate != 0 && is_low_surrogate(unit)) {
      append_utf8(out, 0x10000U + ((surrogate - 0xd800U) << 10U) + (unit - 0xdc00U));
      surrogate = 0;
      continue;
    }
    if (surrogate != 0) append_utf8(out, kNoCharacter);
    surrogate = is_high_surrogate(unit) ? unit : u'\0';
    if (surrogate == 0) append_utf8(out, is_low_surrogate(unit) ? kNoCharacter : char32_t{unit});
  }
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(whole));
  return out;
}

std::string utf8_of(std::string text) {
  const Encoding encoding = encoding_of(std::string_view(text).substr(0, 4));
  if (encoding == Encoding::kUtf8) return text;
  std::vector<char> bytes(text.begin(), text.end());
  char16_t surrogate = 0;
  return utf8_of_utf16(bytes, encoding, surrogate);
}

std::string utf8_of_windows_1252(std::string_view text) {
  constexpr std::array<char32_t, 32> kFrom80 = {0x20ac, 0x81,   0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                                0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, 0x8d,   0x017d, 0x8f,
                                                0x90,   0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                                0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0x9d,   0x017e, 0x0178};
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    append_utf8(out, byte >= 0x80 && byte < 0xa0 ? kFrom80.at(byte - 0x80U) : char32_t{byte});
  }
  return out;
}

}  // namespace steerid
