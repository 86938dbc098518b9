// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The answers of a blind study under seal: a file, and beside the records the SHA-256 that it had before the first
// diagnosis, so that anybody can see that it has not moved since.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fleet/file_hash.hpp"

namespace steerid {

/// Writes FOLDER/sealed/key.json, readable by its owner only, and FOLDER/KEY_SHA256. Gives the SHA-256.
std::string seal(const std::filesystem::path& folder, std::string_view key);

/// The key's text; throws BadInput when it is not the one that was sealed.
[[nodiscard]] std::string open_seal(const std::filesystem::path& folder);

}  // namespace steerid
