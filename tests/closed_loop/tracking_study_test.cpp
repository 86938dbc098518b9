// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study tracking`. Limits: docs/testing.md.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "study/tracking.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

class Tracking : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    found_ = run_tracking_study({.drives = 30, .hours = 3, .changes = 0, .seed = test::seed(81)},
                                [](std::size_t, std::size_t) {});
  }
  inline static Findings found_;
};

TEST_F(Tracking, NothingWindsUpOnACurveOrAtRest) {
  for (const char* rest : {"curve", "rest"}) {
    EXPECT_LE(found_.figure("keeping", rest + std::string(", none, J"), "worst_percent"), 1);
    EXPECT_LE(found_.figure("keeping", rest + std::string(", none, B"), "worst_percent"), 1);
    EXPECT_LE(found_.figure("keeping", rest + std::string(", none, C"), "worst_percent"), 5);
  }
  EXPECT_GT(found_.figure("keeping", "curve, none, C", "worst_percent"), 0.01);  // its slow changes do show C
}

// At most 1.5 s is asked, which all but one drive in a thousand keep; the published method that this replaces
// takes 8 s. With 2 % unmeasured one drive in thirty is late, so that of 30 four are once in 50 runs, but hardly any
// later than 4 s. No wheel of 0.5 Hz and more shows in less than a tenth of a second that it has changed.
TEST_F(Tracking, AnotherArmIsFoundWithinSeconds) {
  EXPECT_LE(found_.figure("following", "none", "p90_s"), 1.5);
  EXPECT_LE(found_.figure("following", "2 %", "median_s"), 1.5);
  EXPECT_LE(found_.figure("following", "2 %", "p90_s"), 4);
  for (const char* unmeasured : {"none", "2 %"}) EXPECT_GT(found_.figure("following", unmeasured, "median_s"), 0.1);
}

// At most one an hour is asked: of three hours the lower end of the rate's interval may not lie above it.
TEST_F(Tracking, RingsSeldomWithoutCause) {
  for (const char* unmeasured : {"none", "2 %", "10 %"}) {
    EXPECT_EQ(found_.figure("resets", unmeasured, "hours"), 3);
    EXPECT_LE(found_.figure("resets", unmeasured, "per_hour_low"), 1);
    EXPECT_GE(found_.figure("resets", unmeasured, "per_hour_high"), found_.figure("resets", unmeasured, "per_hour"));
  }
}

// Garwood's interval of an observed count, from published tables: 0 gives 0 to 3.689, 1 gives 0.0253 to 5.572.
TEST_F(Tracking, TheIntervalOfARateIsPoissons) {
  constexpr std::array<std::array<double, 2>, 4> kInterval = {
      {{0, 3.689}, {0.0253, 5.572}, {0.2422, 7.225}, {0.6187, 8.767}}};
  const auto resets = static_cast<std::size_t>(found_.figure("resets", "none", "resets"));
  ASSERT_LT(resets, kInterval.size());
  EXPECT_NEAR(found_.figure("resets", "none", "per_hour_low") * 3, kInterval[resets][0], 0.001);
  EXPECT_NEAR(found_.figure("resets", "none", "per_hour_high") * 3, kInterval[resets][1], 0.001);
}

// Of 160 seeds (101 to 260) the median of thirty drives is 0.58 to 1.17 s, with 2 % unmeasured 0.56 to 1.62 s; 0.84 s
// on average. Nine drives in ten have C valid and wrong for at most 0.15 to 0.78 s, and 0.27 s on average.
TEST_F(Tracking, AHandThatComesBackIsFound) {
  EXPECT_LT(found_.figure("returning", "none", "off_median_s"), 1.5);
  EXPECT_LT(found_.figure("returning", "2 %", "off_median_s"), 2);
  for (const char* unmeasured : {"none", "2 %"}) {
    EXPECT_GT(found_.figure("returning", unmeasured, "off_median_s"), 0.4) << unmeasured;
    EXPECT_LT(found_.figure("returning", unmeasured, "misleading_p90_s"), 1) << unmeasured;
    EXPECT_GT(found_.figure("returning", unmeasured, "misleading_p90_s"), 0.05) << unmeasured;
  }
}

}  // namespace
}  // namespace steerid
