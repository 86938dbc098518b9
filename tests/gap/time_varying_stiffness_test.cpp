// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A stiffness that changes, where the record shows a part of the change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/hypotheses/hypotheses.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

const Hypothesis& varying() { return *hypothesis_of(effect::time_varying_stiffness); }

struct Arm {
  double damping = 0;
  double stiffness = 0;
};

/// The ramp's law as the vocabulary states it.
Arm arm_at(double t, const WheelArm& wheel, const std::vector<double>& values) {
  const double part = std::clamp((t - values[2]) / values[3], 0.0, 1.0);
  const double ratio = 1 + (values[1] - 1) * part;
  return {wheel.damping_nms_per_rad * std::pow(ratio, values[4]), wheel.stiffness_nm_per_rad * ratio};
}

/// A ramp over 257 s that ends two seconds behind the record's beginning stood in for another C and B.
TEST(TimeVaryingStiffness, IsNoneThatBeganBeforeTheRecord) {
  const Hypothesis::Usual usual{.record = {0, 60}};
  const auto is_one = [&](double shape, double time_s, double length_s) {
    const double values[] = {shape, 0.43, time_s, length_s, 1};
    return varying().beyond_usual(values, usual);
  };
  EXPECT_FALSE(is_one(1, -255, 257.5));
  EXPECT_TRUE(is_one(1, -0.5, 30));
  EXPECT_TRUE(is_one(1, 20, 5));
  EXPECT_FALSE(is_one(0, 59.5, 5));
  EXPECT_FALSE(is_one(0, 0.5, 5));
  EXPECT_TRUE(is_one(2, -255, 20));
}

TEST(TimeVaryingStiffness, IsStatedByThePartOfItsRampThatTheRecordShows) {
  constexpr Hypothesis::Span kRecord{2, 62};
  const WheelArm wheel{0.11, 1.5, 22.7};
  const std::vector<std::vector<double>> ramps = {
      {1, 0.6, -20, 100, 0.5}, {1, 2.5, -20, 30, 1}, {1, 0.4, 30, 300, 0}, {1, 1.5, 10, 20, 0.5}};
  for (const std::vector<double>& ramp : ramps) {
    std::vector<double> stated = ramp;
    WheelArm of = wheel;
    varying().restate(kRecord, stated.data(), &of);
    EXPECT_GE(stated[2], kRecord.begin_s);
    EXPECT_LE(stated[2] + stated[3], kRecord.end_s + 1e-9);
    for (double t = kRecord.begin_s; t <= kRecord.end_s; t += 0.5) {
      const Arm before = arm_at(t, wheel, ramp);
      const Arm after = arm_at(t, of, stated);
      EXPECT_NEAR(after.stiffness, before.stiffness, 1e-9) << "at " << t;
      EXPECT_NEAR(after.damping, before.damping, 1e-9) << "at " << t;
    }
    const auto is_cut = [&](std::size_t number) { return varying().cut_off_by(kRecord, stated.data(), number); };
    EXPECT_EQ(is_cut(2), ramp[2] < kRecord.begin_s);
    EXPECT_EQ(is_cut(3), ramp[2] + ramp[3] > kRecord.end_s);
    EXPECT_FALSE(is_cut(1));
  }
}

TEST(TimeVaryingStiffness, GoesOnToAnEndOfTheRecordAtTheSlopeThatItHas) {
  constexpr Hypothesis::Span kRecord{2, 62};
  const WheelArm wheel{0.11, 1.5, 22.7};
  const std::vector<double> ramp = {1, 0.6, 10, 40, 0};
  for (const std::size_t number : {2U, 3U}) {
    std::vector<double> further = ramp;
    WheelArm of = wheel;
    ASSERT_TRUE(varying().go_on_to_end(kRecord, further.data(), &of, number));
    EXPECT_TRUE(varying().cut_off_by(kRecord, further.data(), number));
    const Arm first = arm_at(10, of, further);
    const Arm second = arm_at(50, of, further);
    EXPECT_NEAR(first.stiffness, wheel.stiffness_nm_per_rad, 1e-9);
    EXPECT_NEAR(second.stiffness, 0.6 * wheel.stiffness_nm_per_rad, 1e-9);
    const double end_s = number == 2 ? kRecord.begin_s : kRecord.end_s;
    EXPECT_NEAR(arm_at(end_s, of, further).stiffness, (1 - 0.01 * (end_s - 10)) * wheel.stiffness_nm_per_rad, 1e-9);
  }
  const auto goes_on = [&](std::vector<double> values, std::size_t number, WheelArm* of) {
    return varying().go_on_to_end(kRecord, values.data(), of, number);
  };
  WheelArm of = wheel;
  EXPECT_FALSE(goes_on(ramp, 1, &of));
  EXPECT_FALSE(goes_on(ramp, 2, nullptr));             // before it C is the simulation's
  EXPECT_FALSE(goes_on({1, 0.2, 10, 40, 0}, 3, &of));  // C would be below zero
  EXPECT_FALSE(goes_on({0, 0.6, 10, 40, 0}, 3, &of));  // a step
  EXPECT_EQ(of.stiffness_nm_per_rad, wheel.stiffness_nm_per_rad);
}

/// Where J, B and C are the simulation's, C at the record's first sample is not theirs: the ramp began before.
TEST(TimeVaryingStiffness, BeganBeforeTheRecordWhereTheWheelIsGiven) {
  constexpr Hypothesis::Span kRecord{0, 60};
  const WheelArm wheel{0.11, 1.5, 22.7};
  const std::vector<double> ramp = {1, 0.6, -20, 100, 0.5};
  std::vector<double> stated = ramp;
  varying().restate(kRecord, stated.data(), nullptr);
  EXPECT_EQ(stated[2], -20);
  EXPECT_FALSE(varying().cut_off_by(kRecord, stated.data(), 2));
  for (double t = 0; t <= 60; t += 0.5) {
    EXPECT_NEAR(arm_at(t, wheel, stated).stiffness, arm_at(t, wheel, ramp).stiffness, 1e-9) << "at " << t;
  }
}

/// An arm that tires from before the record's first sample to after its last: the ramp alone was no candidate, as one
/// that began too early, and stood beside a weight that is not there.
TEST(TimeVaryingStiffness, ThatFallsAllTheTimeIsTheOnlyCause) {
  const std::uint64_t first = test::seed(351);
  for (const std::uint64_t seed : {first, first + 1}) {
    test::DrawnDrive what;
    what.angle_noise_rad = 1e-4;
    what.torque_noise_nm = 0.005;
    const double stiffness = what.wheel.stiffness_nm_per_rad;
    what.torque = [=](double t, double x, double) { return 0.3 * t / 63 * stiffness * x + test::unseen_nm(t) / 2; };
    const Diagnosis diagnosis = diagnose(test::drive(what, seed), test::off_by_five_percent(what.wheel));
    EXPECT_EQ(diagnosis.verdict, "time_varying_stiffness") << "seed " << seed;
    ASSERT_EQ(diagnosis.causes.size(), 1U) << "seed " << seed;
    const Cause& cause = diagnosis.causes.front();
    // Of C at the record's beginning, 3 s after the drive's: 0.7/0.986 at its end.
    EXPECT_NEAR(cause.effect.at("stiffness_ratio"), 0.7 / (1 - 0.3 * 3 / 63), 0.02) << "seed " << seed;
    EXPECT_NEAR(cause.effect.at("time_s"), 0, 4) << "seed " << seed;
    const BoundedValue& ratio = cause.parameters[1];
    EXPECT_LT(ratio.high - ratio.low, 0.1) << "seed " << seed;
  }
}

}  // namespace
}  // namespace steerid::gap
