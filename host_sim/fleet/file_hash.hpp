// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// SHA-256, in hexadecimal: what a file held when an answer was made from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace steerid {

[[nodiscard]] std::string sha256(std::string_view text);

struct FileHash {
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// Of a regular file, in pieces: 2 s a gigabyte. Throws BadInput when it cannot be read.
[[nodiscard]] FileHash sha256_of_file(const std::filesystem::path& file);

}  // namespace steerid
