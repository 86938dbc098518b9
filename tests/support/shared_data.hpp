// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Measured records are not ours to ship: tests find them in a folder beside the checkout, or where STEERID_DATA points.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace steerid::test {

/// Path of `relative` (for example "data/emps.csv") below $STEERID_DATA or, without it, below ../shared beside the
/// source tree; nothing when it is not there.
std::optional<std::filesystem::path> shared_data(std::string_view relative);

}  // namespace steerid::test

/// Binds `path` to the shared file, or skips the test and says aloud why.
#define STEERID_SHARED_OR_SKIP(path, relative)                                   \
  const auto path##_found = ::steerid::test::shared_data(relative);              \
  if (!path##_found)                                                             \
    GTEST_SKIP() << "SKIPPED for want of " << (relative)                         \
                 << ": put it in ../shared or point STEERID_DATA at its folder"; \
  const auto& path = *path##_found
