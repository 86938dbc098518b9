// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Files that hold logs in formats that are not read here, told by their first bytes, each with the command that makes a
// CSV file of it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace steerid {

struct ForeignFile {
  std::string kind;     ///< "an MDF file (MF4)"
  std::string command;  ///< converts `name` to CSV
};

/// Nothing when the bytes are of none that is known. `name` is the file's, for the command.
[[nodiscard]] std::optional<ForeignFile> foreign_file(std::string_view first_bytes, std::string_view name);

/// The command that makes CSV of a topic of an MCAP file whose messages are not read here, as of ROS 1 and protobuf.
[[nodiscard]] std::string mcap_to_csv(std::string_view file, std::string_view topic);

}  // namespace steerid
