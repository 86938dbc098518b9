// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study soak`: three hundred thousand updates of the twenty million, float and fixed point.
#include <gtest/gtest.h>

#include "study/soak.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

TEST(Soak, StaysSoundAndComesBack) {
  const Findings found = run_soak_study({.updates = 300'000, .seed = test::seed(60)}, [](std::size_t, std::size_t) {});
  for (const char* number : {"float", "fixed"}) {
    for (const char* table : {"soak", "zeros"}) {
      EXPECT_EQ(found.figure(table, number, "unsound"), 0);
      EXPECT_EQ(found.figure(table, number, "not_finite"), 0);
      EXPECT_EQ(found.figure(table, number, "overflows"), 0);
      EXPECT_GT(found.figure(table, number, "least_d"), 0);
    }
    // The memory's floor: 0.0003 of a value, squared, over a noise of some 1e-3 Nm^2, cannot be far below this.
    EXPECT_GT(found.figure("soak", number, "least_d"), 1e-8);
    EXPECT_GE(found.figure("soak", number, "hours"), 300'000 * 0.01 / 3600);
    EXPECT_GE(found.figure("soak", number, "excited"), 10);
    EXPECT_GE(found.figure("soak", number, "right_percent"), 90);
    EXPECT_EQ(found.figure("zeros", number, "valid"), 0);
  }
}

}  // namespace
}  // namespace steerid
