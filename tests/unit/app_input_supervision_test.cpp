// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every verdict of the input supervision, and counters that are exact.
#include <gtest/gtest.h>

#include <climits>
#include <functional>
#include <string>

#include "app/input_supervision.hpp"

namespace steerid {

static bool operator==(const InputCounters& a, const InputCounters& b) {
  return a.accepted_after_gap == b.accepted_after_gap && a.invalid_channel == b.invalid_channel &&
         a.out_of_range == b.out_of_range && a.spike == b.spike && a.stuck == b.stuck && a.repeated == b.repeated &&
         a.out_of_order == b.out_of_order && a.late_tick == b.late_tick;
}

namespace {

using Verdict = InputSupervision::Verdict;
constexpr std::int64_t kDayUs = 86'400'000'000;

/// A sample that follows the wheel's motion: a slow ramp, so that nothing is stuck.
Sample good(std::int64_t tick) {
  Sample sample;
  sample.stamp_us = tick * kTickPeriodUs;
  sample.angle_urad = static_cast<std::int32_t>(tick % 1000) * 10;
  return sample;
}

struct Judged {
  Verdict verdict;
  int missing = 0;
};

Judged judge(InputSupervision& supervision, const Sample& sample) {
  Judged judged{Verdict::kReject, -1};
  judged.verdict = supervision.judge(sample, judged.missing);
  return judged;
}

class Supervision : public ::testing::Test {
 protected:
  void SetUp() override {
    EXPECT_EQ(judge(supervision_, good(0)).verdict, Verdict::kResettle);
    for (; tick_ < 10; ++tick_) EXPECT_EQ(judge(supervision_, good(tick_)).verdict, Verdict::kUse);
  }
  InputSupervision supervision_;
  std::int64_t tick_ = 1;
};

TEST_F(Supervision, CountsNothingWhileAllIsWell) {
  EXPECT_TRUE(supervision_.counters() == InputCounters{});
  EXPECT_FALSE(supervision_.faulty());
}

struct Refusal {
  std::string name;
  std::function<void(Sample&)> spoil;
  InputCounters counted;
};

class RefusedSample : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedSample, IsCountedOnceAndForgotten) {
  InputSupervision supervision;
  for (int k = 0; k < 10; ++k) static_cast<void>(judge(supervision, good(k)));
  Sample sample = good(10);
  GetParam().spoil(sample);
  EXPECT_EQ(judge(supervision, sample).verdict, Verdict::kReject);
  EXPECT_TRUE(supervision.counters() == GetParam().counted);
  EXPECT_EQ(supervision.last_stamp_us(), good(9).stamp_us);
  const Judged next = judge(supervision, good(11));
  EXPECT_EQ(next.verdict, Verdict::kBridge);
  EXPECT_EQ(next.missing, 1);
}

const Refusal kRefusals[] = {
    {"AngleInvalid", [](Sample& s) { s.valid_bits = kAllChannelsValid & ~kAngleValid; }, {.invalid_channel = 1}},
    {"DriverInvalid",
     [](Sample& s) { s.valid_bits = kAllChannelsValid & ~kTorqueDriverValid; },
     {.invalid_channel = 1}},
    {"MotorInvalid", [](Sample& s) { s.valid_bits = kAllChannelsValid & ~kTorqueMotorValid; }, {.invalid_channel = 1}},
    {"AngleBeyond", [](Sample& s) { s.angle_urad = 20'000'001; }, {.out_of_range = 1}},
    {"AngleLowest", [](Sample& s) { s.angle_urad = INT32_MIN; }, {.out_of_range = 1}},
    {"DriverLargest", [](Sample& s) { s.torque_driver_mnm = INT32_MAX; }, {.out_of_range = 1}},
    {"MotorLowest", [](Sample& s) { s.torque_motor_mnm = INT32_MIN; }, {.out_of_range = 1}},
    {"Repeated", [](Sample& s) { s.stamp_us = good(9).stamp_us; }, {.repeated = 1}},
    {"LessThanHalfAPeriodOn", [](Sample& s) { s.stamp_us = good(9).stamp_us + 4'999; }, {.repeated = 1}},
    {"Before", [](Sample& s) { s.stamp_us = good(9).stamp_us - 1; }, {.out_of_order = 1}},
    {"ADayBefore", [](Sample& s) { s.stamp_us -= kDayUs; }, {.out_of_order = 1}},
    {"AngleSpike", [](Sample& s) { s.angle_urad = good(9).angle_urad + 400'001; }, {.spike = 1}},
    {"DriverSpike", [](Sample& s) { s.torque_driver_mnm = -20'001; }, {.spike = 1}},
    {"MotorSpike", [](Sample& s) { s.torque_motor_mnm = 20'001; }, {.spike = 1}},
    // The first check that fails decides.
    {"InvalidAndBeyond", [](Sample& s) { s.valid_bits = 0, s.angle_urad = INT32_MAX; }, {.invalid_channel = 1}},
    {"BeyondAndBefore", [](Sample& s) { s.stamp_us = 0, s.angle_urad = INT32_MAX; }, {.out_of_range = 1}},
};

INSTANTIATE_TEST_SUITE_P(All, RefusedSample, ::testing::ValuesIn(kRefusals),
                         [](const auto& refusal) { return refusal.param.name; });

/// Above a torsion bar, with a motor below it that is not examined.
Sample above_bar(std::int64_t tick) {
  Sample sample = good(tick);
  sample.torque_bar_mnm = 300;
  sample.torque_motor_mnm = INT32_MAX;
  sample.torque_driver_mnm = INT32_MIN;
  sample.valid_bits = kAngleValid | kTorqueBarValid | kTorqueMotorValid;
  return sample;
}

TEST(EquationOfTheInput, IsThatOfTheFirstSampleWhichAllowsOne) {
  InputSupervision supervision;
  Sample unexcited = good(0);
  unexcited.valid_bits = kAngleValid | kProbeValid;
  EXPECT_EQ(judge(supervision, unexcited).verdict, Verdict::kReject);
  EXPECT_EQ(supervision.equation(), Equation::kNone);
  EXPECT_EQ(judge(supervision, above_bar(1)).verdict, Verdict::kResettle);
  EXPECT_EQ(supervision.equation(), Equation::kBar);
  EXPECT_EQ(judge(supervision, above_bar(2)).verdict, Verdict::kUse);
  EXPECT_EQ(supervision.last().torque_mnm(), -300);
  EXPECT_EQ(supervision.last().voluntary_mnm, 0);
  EXPECT_EQ(supervision.counters().invalid_channel, 1);
}

TEST(EquationOfTheInput, ChangesAfterAHundredSamplesThatAgreeAndNotBefore) {
  InputSupervision supervision;
  std::int64_t tick = 0;
  for (; tick < 10; ++tick) static_cast<void>(judge(supervision, good(tick)));
  const auto refuse = [&](int samples) {
    for (int k = 0; k < samples; ++k) {
      ASSERT_EQ(judge(supervision, above_bar(tick++)).verdict, Verdict::kReject) << k;
      ASSERT_EQ(supervision.equation(), Equation::kDriverMotor);
    }
  };
  refuse(99);
  EXPECT_TRUE(supervision.faulty());
  // Back in time: nothing has changed, and the count begins anew.
  EXPECT_EQ(judge(supervision, good(tick++)).verdict, Verdict::kResettle);
  refuse(50);
  Sample rim = above_bar(tick++);
  rim.valid_bits = kAngleValid | kTorqueRimValid;  // others do not agree
  EXPECT_EQ(judge(supervision, rim).verdict, Verdict::kReject);
  refuse(50);
  Sample nothing = good(tick++);
  nothing.valid_bits = kAngleValid;
  EXPECT_EQ(judge(supervision, nothing).verdict, Verdict::kReject);
  refuse(99);
  EXPECT_EQ(judge(supervision, above_bar(tick++)).verdict, Verdict::kResettle);
  EXPECT_EQ(supervision.equation(), Equation::kBar);
  EXPECT_EQ(judge(supervision, above_bar(tick++)).verdict, Verdict::kUse);
  EXPECT_FALSE(supervision.faulty());
}

TEST(EquationOfTheInput, TakesTheProbeThatWasAskedForWhereNoneIsDelivered) {
  InputSupervision supervision;
  int missing = 0;
  static_cast<void>(supervision.judge(above_bar(0), missing, 700));
  EXPECT_EQ(supervision.last().probe_mnm, 700);
  Sample delivered = above_bar(1);
  delivered.probe_mnm = -400;
  delivered.valid_bits |= kProbeValid;
  static_cast<void>(supervision.judge(delivered, missing, 700));
  EXPECT_EQ(supervision.last().probe_mnm, -400);
  delivered = above_bar(2);
  delivered.probe_mnm = 100'001;
  delivered.valid_bits |= kProbeValid;
  EXPECT_EQ(supervision.judge(delivered, missing, 700), Verdict::kReject);
  EXPECT_EQ(supervision.counters().out_of_range, 1);
}

TEST_F(Supervision, AcceptsTheEndsOfItsRange) {
  Sample sample = good(tick_);
  sample.angle_urad = good(tick_ - 1).angle_urad + 400'000;
  sample.torque_driver_mnm = 20'000;
  sample.torque_motor_mnm = -20'000;
  EXPECT_EQ(judge(supervision_, sample).verdict, Verdict::kUse);
}

TEST_F(Supervision, BridgesUpToALongGapAndResettlesBeyond) {
  const Judged bridged = judge(supervision_, good(tick_ + 9));
  EXPECT_EQ(bridged.verdict, Verdict::kBridge);
  EXPECT_EQ(bridged.missing, 9);
  const Judged too_long = judge(supervision_, good(tick_ + 9 + 11));
  EXPECT_EQ(too_long.verdict, Verdict::kResettle);
  EXPECT_EQ(supervision_.counters().accepted_after_gap, 2);
}

TEST_F(Supervision, AWheelMayMoveTwiceAsFarInTwoPeriodsAndNoFarther) {
  Sample sample = good(tick_ + 1);
  sample.angle_urad = good(tick_ - 1).angle_urad + 800'001;
  EXPECT_EQ(judge(supervision_, sample).verdict, Verdict::kReject);
  EXPECT_EQ(supervision_.counters().spike, 1);
  sample.angle_urad -= 1;
  EXPECT_EQ(judge(supervision_, sample).verdict, Verdict::kBridge);
}

TEST_F(Supervision, AJumpOfADayAheadIsAGap) {
  Sample sample = good(tick_);
  sample.stamp_us += kDayUs;
  EXPECT_EQ(judge(supervision_, sample).verdict, Verdict::kResettle);
  EXPECT_EQ(supervision_.last_stamp_us(), sample.stamp_us);
}

TEST_F(Supervision, AClockThatWasSetBackIsAcceptedTheTwentiethTime) {
  for (int k = 0; k < 19; ++k) {
    Sample sample = good(tick_ + k);
    sample.stamp_us -= kDayUs;
    EXPECT_EQ(judge(supervision_, sample).verdict, Verdict::kReject) << k;
    EXPECT_EQ(supervision_.faulty(), k >= 9) << k;
  }
  Sample sample = good(tick_ + 19);
  sample.stamp_us -= kDayUs;
  EXPECT_EQ(judge(supervision_, sample).verdict, Verdict::kResettle);
  EXPECT_FALSE(supervision_.faulty());
  EXPECT_EQ(supervision_.counters().out_of_order, 19);
  EXPECT_EQ(supervision_.counters().accepted_after_gap, 0);
}

TEST_F(Supervision, ASensorThatMovedIsAcceptedTheTwentiethTime) {
  int refused = 0;
  for (; refused < 100; ++refused) {
    Sample sample = good(tick_ + refused);
    // Oscillates, so that it is never within reach of the last accepted one before a quarter of a second.
    sample.angle_urad += 10'000'000;
    if (judge(supervision_, sample).verdict == Verdict::kResettle) break;
  }
  EXPECT_EQ(refused, 19);
  EXPECT_EQ(supervision_.counters().spike, 19);
}

TEST_F(Supervision, AngleStuckWhileTheTorqueMoves) {
  Sample sample = good(tick_);
  const std::int32_t stuck_at = sample.angle_urad;
  int first_refused = -1;
  for (int k = 0; k < 100; ++k) {
    sample = good(tick_ + k);
    sample.angle_urad = stuck_at;
    sample.torque_driver_mnm = k % 2 == 0 ? 0 : 1'001;
    if (judge(supervision_, sample).verdict == Verdict::kReject && first_refused < 0) first_refused = k;
  }
  EXPECT_EQ(first_refused, 31);  // the first of the 31 equal ones is no repetition, and of the last the torque is back
  EXPECT_EQ(supervision_.counters().stuck, 69);
  EXPECT_TRUE(supervision_.faulty());
  // The refused seconds are a gap when it moves again.
  EXPECT_EQ(judge(supervision_, good(tick_ + 100)).verdict, Verdict::kResettle);
  EXPECT_FALSE(supervision_.faulty());
}

TEST_F(Supervision, AWheelAtRestIsNotStuckButTellsNothingAfterHalfASecond) {
  for (int k = 0; k < 100'000; ++k) {
    Sample sample = good(tick_ + k);
    sample.angle_urad = 90;
    sample.torque_driver_mnm = k % 2 == 0 ? 0 : 1'000;
    ASSERT_EQ(judge(supervision_, sample).verdict, k < 49 ? Verdict::kUse : Verdict::kStill) << k;
  }
  EXPECT_TRUE(supervision_.still());
  EXPECT_FALSE(supervision_.faulty());
  EXPECT_TRUE(supervision_.counters() == InputCounters{});
  EXPECT_EQ(judge(supervision_, good(tick_ + 100'000)).verdict, Verdict::kResettle);
  EXPECT_FALSE(supervision_.still());
}

/// The limit may be longer than what teaches nothing.
TEST(SupervisionWithLimits, AnAngleIsStuckAfterAsManySamplesAsTheyAllow) {
  const InputLimits limits{.stuck_samples = 200};
  InputSupervision supervision(limits);
  int first_refused = -1;
  for (int k = 0; k < 400; ++k) {
    Sample sample = good(k);
    sample.angle_urad = 90;
    sample.torque_driver_mnm = k == 0 ? 0 : 2000;
    if (judge(supervision, sample).verdict == Verdict::kReject && first_refused < 0) first_refused = k;
  }
  EXPECT_EQ(first_refused, 200);
  EXPECT_EQ(supervision.counters().stuck, 200);
}

TEST(SupervisionOfABar, ABarThatReadsTheSameTellsNothingAndADriversTorqueMay) {
  for (const bool bar : {true, false}) {
    InputSupervision supervision;
    Verdict last = Verdict::kReject;
    for (int k = 0; k < 100; ++k) {
      Sample sample = good(k);
      sample.valid_bits =
          static_cast<std::uint8_t>(kAngleValid | (bar ? kTorqueBarValid : kTorqueDriverValid | kTorqueMotorValid));
      sample.torque_bar_mnm = 12;
      sample.torque_driver_mnm = 12;
      last = judge(supervision, sample).verdict;
    }
    EXPECT_EQ(last, bar ? Verdict::kStill : Verdict::kUse);
  }
}

TEST_F(Supervision, IsFaultyAfterTenTicksWithoutASample) {
  for (int k = 0; k < 9; ++k) supervision_.tick_without_sample();
  EXPECT_FALSE(supervision_.faulty());
  supervision_.tick_without_sample();
  EXPECT_TRUE(supervision_.faulty());
  static_cast<void>(judge(supervision_, good(tick_ + 10)));
  EXPECT_FALSE(supervision_.faulty());
}

TEST_F(Supervision, CountersStopAtTheirEnd) {
  Sample sample = good(tick_);
  sample.valid_bits = 0;
  for (int k = 0; k < 70'000; ++k) static_cast<void>(judge(supervision_, sample));
  for (int k = 0; k < 70'000; ++k) supervision_.late_tick();
  EXPECT_TRUE(supervision_.counters() == (InputCounters{.invalid_channel = 65535, .late_tick = 65535}));
}

// Differences of stamps near the ends of int64 are formed without overflow (the sanitizer looks on).
TEST(SupervisionStamps, MayBeAnything) {
  for (const std::int64_t first : {INT64_MIN, INT64_MIN + 1, std::int64_t{-1}, std::int64_t{0}, INT64_MAX}) {
    for (const std::int64_t second : {INT64_MIN, std::int64_t{-1}, std::int64_t{0}, std::int64_t{1}, INT64_MAX - 1}) {
      InputSupervision supervision;
      Sample sample;
      sample.stamp_us = first;
      EXPECT_EQ(judge(supervision, sample).verdict, Verdict::kResettle);
      sample.stamp_us = second;
      const Judged judged = judge(supervision, sample);
      const InputCounters& c = supervision.counters();
      const int counted = c.accepted_after_gap + c.repeated + c.out_of_order;
      EXPECT_EQ(counted, 1) << first << " then " << second;
      EXPECT_EQ(judged.verdict == Verdict::kReject, c.accepted_after_gap == 0);
    }
  }
}

// A counter of microseconds that wraps from the largest to the smallest number goes on as if nothing had been.
TEST(SupervisionStamps, WrapAround) {
  InputSupervision supervision;
  Sample sample;
  sample.stamp_us = INT64_MAX - 4'999;
  EXPECT_EQ(judge(supervision, sample).verdict, Verdict::kResettle);
  sample.stamp_us = INT64_MIN + 5'000;
  sample.angle_urad = 1;
  EXPECT_EQ(judge(supervision, sample).verdict, Verdict::kUse);
}

}  // namespace
}  // namespace steerid
