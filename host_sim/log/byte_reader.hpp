// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Takes whole numbers, lowest byte first, and texts off the front of bytes. Behind the end there are zeros and empty
// texts, and ok() says so.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace steerid {

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::string_view rest() const { return rest_; }

  std::string_view bytes(std::uint64_t count) {
    ok_ = ok_ && count <= rest_.size();
    const std::string_view taken = rest_.substr(0, std::min<std::uint64_t>(count, rest_.size()));
    rest_.remove_prefix(taken.size());
    return ok_ ? taken : std::string_view();
  }

  std::uint64_t whole(std::size_t count) {
    std::uint64_t value = 0;
    std::size_t i = 0;
    for (const char c : bytes(count)) value |= std::uint64_t{static_cast<unsigned char>(c)} << (8 * i++);
    return value;
  }
  std::uint16_t u16() { return static_cast<std::uint16_t>(whole(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(whole(4)); }
  std::uint64_t u64() { return whole(8); }

  /// Four bytes of length and so many of text.
  std::string_view text() { return bytes(u32()); }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace steerid
