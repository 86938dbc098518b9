// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "support/shared_data.hpp"

#include <cstdlib>

namespace steerid::test {

std::optional<std::filesystem::path> shared_data(std::string_view relative) {
  const char* root = std::getenv("STEERID_DATA");
  const std::filesystem::path base =
      root != nullptr ? std::filesystem::path(root) : std::filesystem::path(STEERID_SOURCE_DIR) / ".." / "shared";
  const std::filesystem::path path = base / relative;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

}  // namespace steerid::test
