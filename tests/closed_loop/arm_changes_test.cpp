// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The measures of following on signals with known answers, and a short run of the changes of `steerid study tracking`.
#include "study/arm_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "study/following.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// A ramp from 20 to 40 within 5 s and 10 s more, as a course of 10 ms ticks, `late_s` later and `off` times as large.
std::vector<double> ramp(double late_s, double off = 1) {
  std::vector<double> values;
  for (int k = 0; k < 1500; ++k) {
    values.push_back(off * (20 + 20 * std::clamp((0.01 * k - late_s) / 5, 0.0, 1.0)));
  }
  return values;
}

TEST(Following, OfAnEstimateThatIsRightIsWithoutError) {
  const Following f = following_of({{ramp(0), ramp(0)}, {ramp(0), ramp(0)}}, 5);
  EXPECT_DOUBLE_EQ(f.total, 0);
  EXPECT_DOUBLE_EQ(f.accounted, 1);
  EXPECT_DOUBLE_EQ(f.lag_s, 0);
  EXPECT_DOUBLE_EQ(f.settled_p90_s, 0);
  EXPECT_NEAR(f.rise_s, 4, 0.021);  // 10 to 90 % of 5 s
  EXPECT_NEAR(f.truth_rise_s, 4, 0.021);
}

TEST(Following, FindsTheDelay) {
  const Following f = following_of({{ramp(0), ramp(1.5)}, {ramp(0), ramp(1.5)}}, 5);
  EXPECT_NEAR(f.lag_s, 1.5, 1e-9);
  EXPECT_DOUBLE_EQ(f.random, 0);
  EXPECT_GT(f.bias, 0.05);
  // 6 Nm/rad behind on 40 are 15 %, which is what it is at the ramp's end: settled within a tick of it.
  EXPECT_LE(f.settled_median_s, 0.02);
  EXPECT_NEAR(following_of({{ramp(0), ramp(2.5)}}, 5).settled_median_s, 1, 0.02);  // 10 Nm/rad behind
}

TEST(Following, TellsBiasFromSpread) {
  const Following f = following_of(
      {{ramp(0), ramp(0, 1.1)}, {ramp(0), ramp(0, 0.9)}, {ramp(0), ramp(0, 1.06)}, {ramp(0), ramp(0, 0.98)}}, 5);
  EXPECT_NEAR(f.bias, 0.01, 1e-9);                                          // mean of +10, -10, +6 and -2 %
  EXPECT_NEAR(f.random, std::sqrt((81 + 121 + 25 + 9) / 4.0) / 100, 1e-9);  // of their spread about it
  EXPECT_NEAR(f.total, std::sqrt((100 + 100 + 36 + 4) / 4.0) / 100, 1e-9);
}

TEST(Following, OfAnArmThatStaysKnowsNoLag) {
  const std::vector<double> constant(500, 3.0);
  const Following f = following_of({{constant, constant}}, 0);
  EXPECT_TRUE(std::isnan(f.lag_s));
  EXPECT_TRUE(std::isnan(f.accounted));
  EXPECT_TRUE(std::isnan(f.rise_s));
}

class ArmChanges : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    add_arm_changes(found_, {.drives = 2, .seed = test::seed(41)}, [](std::size_t, std::size_t) {});
  }
  inline static Findings found_;
};

TEST_F(ArmChanges, TellsEveryKindInBothWorlds) {
  ASSERT_EQ(found_.tables.size(), 3U);
  EXPECT_EQ(found_.tables[0].rows.size(), 32U * 2 * 3);
  EXPECT_EQ(found_.tables[1].rows.size(), 32U * 2);
  EXPECT_EQ(found_.tables[2].rows.size(), 2U * 3);
  EXPECT_EQ(found_.asked.size(), 8U);
}

// The bound of a driver whose torque is known lies below that of one whose torque hides the arm; and a faster change
// is harder to follow.
TEST_F(ArmChanges, BoundsGrowWithWhatIsHidden) {
  const auto bound = [&](const char* change, const char* torque) {
    return found_.figure("changes", std::string(change) + ", " + torque + ", C", "bound_percent");
  };
  for (const char* change : {"C x2 within 2 s", "C x2 within 20 s", "C swings by 50 %, 15 s"}) {
    EXPECT_GT(bound(change, "bar"), 2 * bound(change, "known")) << change;
    EXPECT_GT(bound(change, "known"), 0.1) << change;
    EXPECT_LT(bound(change, "bar"), 60) << change;
  }
  EXPECT_GT(bound("C swings by 50 %, 8 s", "bar"), bound("C swings by 50 %, 60 s", "bar"));
}

// Asked: at most 2 % of the valid ticks wrong in every kind. In the mean over the kinds it was 14, 35 and 56 % of J, B
// and C without the follower, and is 0.5, 2.3 and 2.1 % with it (docs/adr/0005, other draws). 4 % is the most that is
// taken for following; far below a tenth of it would be drives that do not change. Valid are 80, 79 and 84 % there.
TEST_F(ArmChanges, AreFollowedWhereAllTorqueIsKnown) {
  const auto known = [&](const char* parameter, const char* key) {
    return found_.figure("over_kinds", std::string("known, ") + parameter, key);
  };
  for (const char* parameter : {"J", "B", "C"}) EXPECT_LE(known(parameter, "wrong_of_valid_percent"), 4) << parameter;
  EXPECT_GE(known("C", "wrong_of_valid_percent"), 0.2);
  EXPECT_GE(known("J", "valid_percent"), 70);
  EXPECT_GE(known("B", "valid_percent"), 65);
  EXPECT_GE(known("C", "valid_percent"), 70);
}

TEST_F(ArmChanges, TheTruthRisesAsItIsTold) {
  EXPECT_NEAR(found_.figure("changes", "C x2 within 20 s, bar, C", "truth_rise_s"), 16, 0.03);
  EXPECT_NEAR(found_.figure("changes", "B x2 within 30 s, known, B", "truth_rise_s"), 24, 0.03);
  EXPECT_TRUE(std::isnan(found_.figure("changes", "B x2 within 30 s, known, C", "lag_s")));
}

}  // namespace
}  // namespace steerid
