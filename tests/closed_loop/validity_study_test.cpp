// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study validity`: the counts of its table. Limits: docs/testing.md.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "study/over_kinds.hpp"
#include "study/validity.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

TEST(Validity, CountsEveryKind) {
  const Findings found =
      run_validity_study({.drives = 1, .minutes = 1, .seed = test::seed(61)}, [](std::size_t, std::size_t) {});
  ASSERT_EQ(found.tables.size(), 2U);
  EXPECT_EQ(found.tables[0].rows.size(), 35U * 4);
  EXPECT_EQ(found.tables[1].rows.size(), 2U * 4);
  EXPECT_EQ(found.asked.size(), 35U * 2);
  EXPECT_TRUE(std::isnan(found.figure("validity", "an arm that stays, known, C", "lag_s")));
  EXPECT_GE(found.figure("validity", "C ramps within 2 to 20 s, in a minute, known, C", "lag_s"), 0);
  EXPECT_EQ(found.figure("over_kinds", "known, C", "kinds"), 18);
  EXPECT_EQ(found.figure("over_kinds", "bar, C", "kinds"), 17);
}

// Two kinds in two worlds, worked out by hand.
TEST(OverKinds, IsTheMeanOfTheKindsAndTheirLongestStretch) {
  const auto column = [](const char* key) { return FoundColumn{key, {.label = key}}; };
  const FoundTable table{"kinds",
                         "",
                         "",
                         {column("kind"), column("torque"), column("parameter"), column("longest_wrong_s"),
                          column("valid_percent"), column("wrong_of_valid_percent")},
                         {{"stays", "known", "J", 0.1, 100.0, 2.0},
                          {"stays", "bar", "J", 4.0, 50.0, 10.0},
                          {"ramps", "known", "J", 0.7, 50.0, 2.5},
                          {"ramps", "bar", "J", 0.0, 0.0, std::nan("")}}};
  const FoundTable over = over_kinds(table);
  ASSERT_EQ(over.rows.size(), 2U);
  Findings found;
  found.tables = {over};
  EXPECT_EQ(found.figure("over_kinds", "known, J", "kinds"), 2);
  EXPECT_EQ(found.figure("over_kinds", "known, J", "valid_percent"), 75);
  EXPECT_EQ(found.figure("over_kinds", "known, J", "wrong_of_valid_percent"), 2.25);
  EXPECT_EQ(found.figure("over_kinds", "known, J", "longest_wrong_s"), 0.7);
  EXPECT_EQ(found.figure("over_kinds", "known, J", "kinds_above"), 1);
  EXPECT_EQ(found.figure("over_kinds", "bar, J", "wrong_of_valid_percent"), 5);
  EXPECT_EQ(found.figure("over_kinds", "bar, J", "kinds_above"), 1);
  FoundTable without = table;
  without.columns[3].key = "longest_s";
  EXPECT_THROW((void)over_kinds(without), std::out_of_range);
}

}  // namespace
}  // namespace steerid
