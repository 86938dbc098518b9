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

// Every detector, by the median and by 99 %.
TEST_F(Hands, DrawsTheWholeTradeOff) {
  ASSERT_EQ(found_.lines.size(), 3U);
  for (const report::LineChart& chart : found_.lines) EXPECT_EQ(chart.series.size(), 5U) << chart.title;
  EXPECT_EQ(found_.asked.size(), 4U);
}

// Half of the drives are held by an arm, half of them are on a smooth road: both divide the same alarms.
TEST_F(Hands, CountsTheSameAlarmsByRoadAndByHand) {
  for (const char* row : {"steerid, 0 s", "bar below 0.3 Nm, 2 s", "bar below 1 Nm, 12 s"}) {
    const auto of = [&](const char* key) { return found_.figure("hands", row, key); };
    EXPECT_NEAR(of("false_smooth_per_h") + of("false_rough_per_h"), of("false_arm_per_h") + of("false_fingers_per_h"),
                1e-9)
        << row;
    EXPECT_LE(of("false_time_percent"), 100) << row;
  }
}

// The roads divide the same arms. A probe that need not overcome the rack's friction tells no fewer of them.
TEST_F(Hands, SplitsTheArmsThatBraceByRackAndRoad) {
  const auto missed = [&](const std::string& row) { return found_.figure("braced", row, "missed_percent"); };
  const std::string braced = "relaxed, then braced";
  const std::string free = "the same, rack without friction";
  EXPECT_NEAR(missed(braced), (missed(braced + ", smooth road") + missed(braced + ", rough road")) / 2, 1e-9);
  EXPECT_LE(missed(free), missed(braced));
  EXPECT_LT(missed(free + ", smooth road"), 100);
}

// A light touch has no state of its own: what is told of it is that nothing is known, and seldom anything else. Of the
// drives of 20 hours it is `unknown` on 99.97 % of the ticks; an hour has 36 drives with fingers.
TEST_F(Hands, TellsNothingOfALightTouch) {
  const auto of = [&](const char* who, const char* key) { return found_.figure("states", who, key); };
  EXPECT_GT(of("two fingers", "unknown_percent"), 99);
  EXPECT_GT(of("nobody", "hands_off_percent"), 10);
  for (const char* who : {"an arm", "two fingers", "nobody", "nobody, held out"}) {
    const double sum = of(who, "hands_off_percent") + of(who, "relaxed_percent") + of(who, "braced_percent") +
                       of(who, "unknown_percent");
    EXPECT_NEAR(sum, 100, 1e-9) << who;
  }
}

}  // namespace
}  // namespace steerid
