// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study hands`. Limits: docs/testing.md.
#include <gtest/gtest.h>

#include <string>

#include "study/hands.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

class Hands : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    found_ = run_hands_study({.drives = 8, .hours = 1, .seed = test::seed(51)}, [](std::size_t, std::size_t) {});
  }
  inline static Findings found_;
};

// A longer hold tells later, and a threshold of 0.3 Nm, which two fingers exceed now and then, alarms less often by it.
TEST_F(Hands, AThresholdTradesTimeForFalseAlarms) {
  const auto of = [&](const char* nm, const char* hold, const char* key) {
    return found_.figure("hands", std::string("bar below ") + nm + " Nm, " + hold, key);
  };
  for (const char* nm : {"0.3", "0.5", "0.7", "1"}) {
    EXPECT_LE(of(nm, "0.5 s", "median_s"), of(nm, "2 s", "median_s")) << nm;
  }
  EXPECT_GT(of("0.3", "0.5 s", "false_smooth_per_h"), of("0.3", "8 s", "false_smooth_per_h"));
  // Two fingers pull less than 1 Nm for 2 s: that is why cars wait for 15 s.
  EXPECT_GT(found_.figure("hands", "bar below 1 Nm, 2 s", "false_smooth_per_h"), 1);
}

TEST_F(Hands, DrawsTheWholeTradeOff) {
  ASSERT_EQ(found_.lines.size(), 1U);
  EXPECT_GE(found_.lines[0].series.size(), 4U);
  EXPECT_EQ(found_.asked.size(), 4U);
}

}  // namespace
}  // namespace steerid
