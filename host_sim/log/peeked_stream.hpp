// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A stream whose first bytes can be looked at before it is read, also where it cannot be wound back. Where the stream
// beneath can be, seekg(0) winds it back; it goes to no other place.
#pragma once

#include <array>
#include <cstddef>
#include <istream>
#include <memory>
#include <streambuf>
#include <string_view>
#include <vector>

namespace steerid {

class PeekedStream : public std::istream {
 public:
  static constexpr std::size_t kPeekedBytes = 4096;

  explicit PeekedStream(std::unique_ptr<std::istream> stream);

  /// Up to kPeekedBytes; fewer when the stream has no more.
  [[nodiscard]] std::string_view first_bytes() const { return {buffer_.first.data(), buffer_.first.size()}; }

 private:
  /// The first bytes, then the rest of the stream.
  struct Buffer : std::streambuf {
    explicit Buffer(std::unique_ptr<std::istream> stream);
    int_type underflow() override;
    pos_type seekpos(pos_type position, std::ios_base::openmode which) override;

    std::unique_ptr<std::istream> in;
    std::vector<char> first;
    std::vector<char> block;
  };

  Buffer buffer_;
};

}  // namespace steerid
