// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "log/bad_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace steerid {
namespace {

/// Bytes of the character that `text` starts with when it is printable: ASCII, or well-formed UTF-8 from U+00A0 on
/// (below are control characters). 0 otherwise.
std::size_t printable_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto lead = byte(0);
  if (lead >= 0x20 && lead < 0x7f) return 1;
  const std::size_t length = lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead < 0xf5 ? 4 : 0;
  if (lead < 0xc2 || length == 0) return 0;
  char32_t point = lead & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
    point = (point << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::array<char32_t, 5> kLeast = {0, 0, 0xa0, 0x800, 0x10000};
  const bool surrogate = point >= 0xd800 && point < 0xe000;
  const bool separator = point == 0x2028 || point == 0x2029;  // line and paragraph
  return point < kLeast[length] || point > 0x10ffff || surrogate || separator ? 0 : length;
}

}  // namespace

BadInput bad_input(const Complaint& complaint) {
  std::string sentence = complaint.file;
  if (complaint.line != 0) sentence += fmt::format(", line {}", complaint.line);
  if (!complaint.column.empty()) sentence += ", column " + in_quotes(complaint.column, '\'');
  if (!sentence.empty()) sentence += ": ";
  sentence += fmt::format("expected {}", complaint.expected);
  if (!complaint.found.empty()) sentence += fmt::format(", found {}", complaint.found);
  if (!complaint.advice.empty()) sentence += fmt::format("; {}", complaint.advice);
  return BadInput(sentence);
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = printable_bytes(text.substr(i));
    if (length == 0) out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
    out += text.substr(i, length);
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string in_quotes(std::string_view text, char quote) {
  constexpr std::size_t kMostBytes = 40;
  std::size_t end = 0;
  while (end < text.size() && end < kMostBytes) end += std::max<std::size_t>(printable_bytes(text.substr(end)), 1);
  return quote + printable(text.substr(0, end)) + (end < text.size() ? "..." : "") + quote;
}

}  // namespace steerid
