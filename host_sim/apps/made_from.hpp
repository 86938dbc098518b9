// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// All that an answer hangs on: the program, and what stood in the files. An answer that was made from the same is the
// same.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace steerid {

/// SHA-256 of this very program: a version's number stays while its code is worked on, the program's own bytes do not.
[[nodiscard]] const std::string& this_program();

/// {"version":,"sha256":} of this program.
[[nodiscard]] nlohmann::ordered_json program_json();

/// {"name":,"bytes":,"sha256":} of a file that was read; as fingerprint() below otherwise.
[[nodiscard]] nlohmann::ordered_json input_json(const std::filesystem::path& file);

/// {"bytes":,"sha256":} of a file; of standard input, of which nothing is known any more once it has been read, null
/// for both. Throws BadInput when it cannot be read.
[[nodiscard]] nlohmann::ordered_json fingerprint(const std::filesystem::path& file);

}  // namespace steerid
