// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study faults`: six drives of each defect, sixty mixtures. Limits: docs/testing.md.
#include <gtest/gtest.h>

#include <algorithm>

#include "study/fault_campaign.hpp"
#include "study/fault_catalogue.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

class Faults : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    found_ = run_fault_study({.drives = 6, .seed = test::seed(70)}, [](std::size_t, std::size_t) {});
  }
  static double of(const Fault& fault, const char* figure) {
    constexpr const char* kClasses[] = {"refused", "misfit", "not visible"};
    return found_.figure("faults", std::string(kClasses[static_cast<int>(fault.kind)]) + ", " + fault.name, figure);
  }
  inline static Findings found_;
};

TEST_F(Faults, NeverAnOutputThatIsNoNumberOrOutOfRange) {
  for (const Fault& fault : all_faults()) EXPECT_EQ(of(fault, "unsound"), 0) << fault.name;
  EXPECT_EQ(found_.figure("faults", "mixture, two of these", "unsound"), 0);
}

TEST_F(Faults, RefusedOnesDoNotMislead) {
  for (const Fault& fault : all_faults()) {
    if (fault.kind != FaultClass::kRefused) continue;
    EXPECT_EQ(of(fault, "misled_s"), 0) << fault.name;
    EXPECT_GT(of(fault, "fault_s"), 5) << fault.name;
    EXPECT_LE(of(fault, "recovery_median_s"), 5) << fault.name;  // as asked; the slowest of a stuck angle takes longer
  }
}

// With seeds 101 to 140 these 108 drives are misled for 22 of 20,000 s: for 3.6 of some 500 s in the worst run of the
// 40, and for a fifth of the time of a single fault at most. The limits are twice the former and half as much again as
// the latter.
TEST_F(Faults, MisfitsMisleadSeldom) {
  double misled_s = 0;
  double fault_s = 0;
  for (const Fault& fault : all_faults()) {
    if (fault.kind != FaultClass::kMisfit) continue;
    misled_s += of(fault, "misled_s");
    fault_s += of(fault, "fault_s");
    EXPECT_GT(of(fault, "fault_s"), 5) << fault.name;
    EXPECT_LE(of(fault, "misled_s"), 0.3 * of(fault, "fault_s")) << fault.name;
    EXPECT_LE(of(fault, "recovery_median_s"), 5) << fault.name;
  }
  EXPECT_LE(misled_s, 0.015 * fault_s);
}

/// Percent of the misfits' drives.
double right_again_within_5_s(const Findings& found) {
  const auto share = std::ranges::find_if(
      found.asked, [](const AskedFigure& one) { return one.what.starts_with("class misfit: share"); });
  return share == found.asked.end() ? -1 : share->measured;
}

/// 3596 of 3600 drives with ten seeds are; fewer than 106 of the 108 here would be with a probability of 1 in 3900.
TEST_F(Faults, MisfitsAreOverFiveSecondsAfterTheirEnd) { EXPECT_GE(right_again_within_5_s(found_), 98); }

/// 44.6 % of 1800 drives with five seeds are, which have a standard error of 7 % in the 54 here.
TEST(FaultsBehindUnmeasuredTorque, TakeLonger) {
  const Findings found =
      run_fault_study({.drives = 3, .seed = test::seed(72), .unmeasured_percent = 10}, [](std::size_t, std::size_t) {});
  EXPECT_GT(right_again_within_5_s(found), 44 - 4 * 7);
  EXPECT_LT(right_again_within_5_s(found), 44 + 4 * 7);
  EXPECT_TRUE(found.command.ends_with("--unmeasured 10")) << found.command;
}

TEST_F(Faults, CountersAreExact) {
  int counted = 0;
  for (const Fault& fault : all_faults()) {
    if (!fault.counters) continue;
    ++counted;
    EXPECT_EQ(of(fault, "counters_off"), 0) << fault.name;
  }
  EXPECT_EQ(counted, 12);
}

/// The counters at the end of a drive with 500 spoiled samples, 20 s to 25 s, counted off by hand.
InputCounters counters(const std::function<void(Sample&, int)>& bus) {
  return faulty_drive({.name = "", .bus = bus}, {20, 5}, 30, test::seed(71), {0.11, 1.5, 22.7})
      .outcomes.back()
      .estimate.counters;
}

TEST(FaultCounters, AreThoseCountedOffByHand) {
  EXPECT_EQ(counters([](Sample& s, int) { s.valid_bits = 0; }).invalid_channel, 500);
  EXPECT_EQ(counters([](Sample& s, int) { s.angle_urad = INT32_MIN; }).out_of_range, 500);
  EXPECT_EQ(counters([](Sample& s, int k) { s.stamp_us -= k * kTickPeriodUs; }).repeated, 499);  // the first is fresh
  const InputCounters back = counters([](Sample& s, int) { s.stamp_us -= 86'400'000'000; });
  EXPECT_EQ(back.out_of_order, 19);
  EXPECT_EQ(back.accepted_after_gap, 1);  // the way forth again
  const InputCounters spikes = counters([](Sample& s, int k) { s.angle_urad += k % 5 == 0 ? 1'000'000 : 0; });
  EXPECT_EQ(spikes.spike, 100);
  EXPECT_EQ(spikes.accepted_after_gap, 100);
  EXPECT_EQ(spikes.out_of_range + spikes.repeated + spikes.out_of_order + spikes.stuck, 0);
}

}  // namespace
}  // namespace steerid
