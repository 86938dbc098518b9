// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The CRC against the catalogue's check value and against a division bit by bit.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "base/crc32.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

std::uint32_t bit_by_bit(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t rest = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      const std::uint32_t out = (rest ^ (static_cast<std::uint32_t>(byte) >> bit)) & 1U;
      rest = (rest >> 1U) ^ (out != 0U ? 0xEDB88320U : 0U);
    }
  }
  return ~rest;
}

TEST(Crc32, IsThatOfTheCatalogue) {
  const std::vector<std::uint8_t> check{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc32(check), 0xCBF43926U);
  EXPECT_EQ(crc32({}), 0U);
}

TEST(Crc32, EqualsADivisionBitByBit) {
  std::mt19937_64 random(test::seed(90));
  for (std::size_t length = 1; length < 100; ++length) {
    std::vector<std::uint8_t> bytes(length);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    ASSERT_EQ(crc32(bytes), bit_by_bit(bytes));
  }
}

}  // namespace
}  // namespace steerid
