// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The files that the program reads, all of them opened here: regular files, and "-" for standard input. A pipe without
// a partner would be waited for without end, and a device such as /dev/zero has none; both are refused, as a folder is,
// with one sentence.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace steerid {

inline constexpr std::uint64_t kMostBytesOfJson = std::uint64_t{16} << 20;

/// Throws BadInput unless `file` can be opened for reading and is a regular file, a link to one, or "-". `what` is what
/// it should be: "a CSV file".
void check_input_file(const std::filesystem::path& file, std::string_view what = "a file");

/// The bytes of a file that is read whole. Throws BadInput as above, and when it has more than `most_bytes`.
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& file, std::string_view what,
                                          std::uint64_t most_bytes = kMostBytesOfJson);

}  // namespace steerid
