// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The three parts of a record that gaps cut.
#include "gap/likelihood/held_out_split.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <vector>

namespace steerid::gap {
namespace {

/// Stamps at 100 Hz, of stretches of `length_s` with 0.6 s missing after each.
Record cut_into(const std::vector<double>& length_s) {
  Record record;
  double begin_s = 0;
  for (const double one : length_s) {
    for (int i = 0; i < 100 * one; ++i) record.time_s.push_back(begin_s + 0.01 * i);
    begin_s += one + 0.6;
  }
  return record;
}

std::array<std::size_t, 3> samples_of(const std::vector<Block>& blocks) {
  std::array<std::size_t, 3> samples{};
  for (const Block& block : blocks) samples[static_cast<std::size_t>(block.role)] += block.count;
  return samples;
}

TEST(HeldOutSplit, OfAWholeRecordHalfFits) {
  const auto [fit, choose, report] = samples_of(held_out_split(cut_into({60})));
  EXPECT_EQ(fit + choose + report, 6000U);
  EXPECT_EQ(fit, 3000U);
  EXPECT_EQ(choose, report);
}

TEST(HeldOutSplit, StretchesBetweenGapsAreBlocksAsAWhole) {
  const Record record = cut_into(std::vector<double>(15, 3.24));
  const std::vector<Block> blocks = held_out_split(record);
  ASSERT_EQ(blocks.size(), 15U);
  const auto [fit, choose, report] = samples_of(blocks);
  EXPECT_EQ(fit, 8U * 324);
  EXPECT_EQ(choose, 4U * 324);
  EXPECT_EQ(report, 3U * 324);
  for (std::size_t i = 0; i < blocks.size(); ++i) EXPECT_EQ(blocks[i].first, 324 * i);
  // Another part reports in the next turn.
  const std::vector<Block> turned = held_out_split(record, 1);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_FALSE(blocks[i].role == Block::Role::kReport && turned[i].role == Block::Role::kReport);
  }
}

TEST(HeldOutSplit, ALongStretchIsCutAsItIsWithoutTheShortOnesBesideIt) {
  const std::vector<Block> alone = held_out_split(cut_into({30}));
  const std::vector<Block> beside = held_out_split(cut_into({30, 4, 0.5}));
  ASSERT_EQ(beside.size(), alone.size() + 1);  // half a second is too short to be anything
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(beside[i].first, alone[i].first);
}

TEST(HeldOutSplit, TooLittleIsNothing) {
  EXPECT_TRUE(held_out_split(cut_into({5.4})).empty());
  EXPECT_TRUE(held_out_split(cut_into({5, 5, 5})).empty());  // nothing would report
  EXPECT_FALSE(held_out_split(cut_into({5, 5, 5, 5})).empty());
  EXPECT_TRUE(held_out_split(cut_into(std::vector<double>(40, 0.65))).empty());
  EXPECT_FALSE(held_out_split(cut_into({6})).empty());
}

}  // namespace
}  // namespace steerid::gap
