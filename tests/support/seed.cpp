// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "support/seed.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace steerid::test {

std::uint64_t seed(std::uint64_t fallback) {
  const char* given = std::getenv("STEERID_SEED");
  const std::uint64_t value = given != nullptr ? std::strtoull(given, nullptr, 0) : fallback;
  std::printf("seed %llu (repeat with STEERID_SEED=%llu)\n", static_cast<unsigned long long>(value),
              static_cast<unsigned long long>(value));
  ::testing::Test::RecordProperty("seed", std::to_string(value));
  return value;
}

}  // namespace steerid::test
