// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study validity`: the counts of its table. Limits: docs/testing.md.
#include <gtest/gtest.h>

#include <string>

#include "study/validity.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

TEST(Validity, CountsEveryKind) {
  const Findings found =
      run_validity_study({.drives = 1, .minutes = 1, .seed = test::seed(61)}, [](std::size_t, std::size_t) {});
  ASSERT_EQ(found.tables.size(), 1U);
  EXPECT_EQ(found.tables[0].rows.size(), 27U * 4);
  EXPECT_EQ(found.asked.size(), 27U * 2);
}

}  // namespace
}  // namespace steerid
