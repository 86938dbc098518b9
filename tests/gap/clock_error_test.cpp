// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A drift between the clocks of angle and torque (gap/drawn_drive.hpp makes the drives).
#include "gap/diagnosis/clock_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "gap/compared_drive.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/together.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

test::DrawnDrive quiet() {
  test::DrawnDrive what;
  what.torque_noise_nm = 0.005;
  what.angle_noise_rad = 1e-4;
  return what;
}

/// The record of a drive whose angle comes later by so many seconds every second: what the wheel does at t stands at
/// t + d t, to first order in d.
test::DrawnDrive drifting(double per_s) {
  test::DrawnDrive what = quiet();
  what.delay_by_s = [per_s](double t) { return per_s * std::max(0.0, t - 3); };  // the record begins then
  return what;
}

/// What a wheel with free J, B and C leaves of the drive.
struct Left {
  Left(const test::DrawnDrive& what, std::uint64_t seed) : compared(what, seed), fitter(compared.setting) {
    EffectSet wheel;
    wheel.wheel_given = false;
    fit = fitter.fit(wheel, {what.wheel, {}});
  }
  [[nodiscard]] bool drift_matters() const {
    const std::optional<ClockError> drift = clock_error_left(fit, fitter, ClockError::Course::kGrowing);
    return drift && drift->matters();
  }

  test::ComparedDrive compared;
  SetFitter fitter;
  FittedSet fit;
};

TEST(ClockDrift, IsReadOffWhatAWheelLeaves) {
  const std::uint64_t seed = test::seed(361);
  for (const double per_s : {2e-4, 5e-5}) {
    const Left left(drifting(per_s), seed);
    const std::optional<ClockError> drift = clock_error_left(left.fit, left.fitter, ClockError::Course::kGrowing);
    ASSERT_TRUE(drift);
    EXPECT_NEAR(drift->size, per_s, 0.1 * per_s);
    EXPECT_GT(drift->share, 0.8);
    EXPECT_TRUE(left.drift_matters());
  }
}

TEST(ClockDrift, DoesNotMatterInOtherGaps) {
  const std::uint64_t seed = test::seed(362);
  EXPECT_FALSE(Left(quiet(), seed).drift_matters());
  test::DrawnDrive late = quiet();
  late.delay_s = 0.01;
  EXPECT_FALSE(Left(late, seed).drift_matters());
  test::DrawnDrive bent = quiet();
  bent.torque = [](double, double x, double) { return -300 * x * x * x; };
  EXPECT_FALSE(Left(bent, seed).drift_matters());
  test::DrawnDrive dry = quiet();
  dry.dry_friction_nm = 0.3;
  EXPECT_FALSE(Left(dry, seed).drift_matters());
}

/// An arm that damps more and more, or is softer and softer, is late by more and more where it is slow, and not where
/// it is fast. What is left of it beyond the first order is no drift of two clocks, which is 20 ppm and more.
TEST(ClockDrift, DoesNotMatterInAnArmThatChanges) {
  const std::uint64_t seed = test::seed(363);
  test::DrawnDrive what = quiet();
  const double damping = what.wheel.damping_nms_per_rad;
  what.torque = [damping](double t, double, double v) { return -damping * t / 63 * v; };
  const Left damped(what, seed);
  EXPECT_LT(std::abs(clock_error_left(damped.fit, damped.fitter, ClockError::Course::kGrowing).value().size), 1e-5);
  const double stiffness = what.wheel.stiffness_nm_per_rad;
  what.torque = [stiffness](double t, double x, double) { return -0.3 * stiffness * t / 63 * x; };
  EXPECT_FALSE(Left(what, seed).drift_matters());
}

bool says_drift(const Diagnosis& answer) {
  return std::ranges::any_of(answer.notes, [](const std::string& note) { return note.starts_with("the clocks of"); });
}

TEST(ClockDrift, IsTakenOffBeforeAnythingIsSearched) {
  const std::uint64_t seed = test::seed(364);
  Simulation simulation;
  simulation.wheel = quiet().wheel;
  const Diagnosis exact = diagnose(test::drive(drifting(1.5e-4), seed), simulation);
  EXPECT_EQ(exact.verdict, "none");
  EXPECT_TRUE(says_drift(exact));
  test::DrawnDrive bent = drifting(1.5e-4);
  bent.torque = [](double, double x, double) { return -150 * x * x * x; };
  const Diagnosis hardened = diagnose(test::drive(bent, seed), simulation);
  EXPECT_EQ(hardened.verdict, "cubic_stiffness");
  EXPECT_TRUE(says_drift(hardened));
  bent.delay_by_s = {};
  const Diagnosis one_clock = diagnose(test::drive(bent, seed), simulation);
  EXPECT_EQ(one_clock.verdict, "cubic_stiffness");
  EXPECT_FALSE(says_drift(one_clock));
}

TEST(ClockDrift, IsTakenOffEachOfSeveralRecords) {
  const std::uint64_t seed = test::seed(365);
  test::DrawnDrive bent = drifting(1e-4);
  bent.torque = [](double, double x, double) { return -150 * x * x * x; };
  const Record first = test::drive(bent, seed);
  bent.delay_by_s = {};
  const Record second = test::drive(bent, seed + 1);
  Simulation simulation;
  simulation.wheel = bent.wheel;
  const Together together = diagnose_together(std::vector<NamedRecord>{{"a", first}, {"b", second}}, simulation);
  EXPECT_EQ(together.records.front().verdict, "cubic_stiffness");
  EXPECT_TRUE(says_drift(together.records[0]));
  EXPECT_FALSE(says_drift(together.records[1]));
}

/// Rows of 5 ms that hold its samples, the angle's every second one.
Record held(const Record& record) {
  Record rows = record;
  rows.time_s.clear();
  rows.torque_driver_nm.clear();
  rows.torque_motor_nm.clear();
  rows.angle_rad.clear();
  for (std::size_t i = 0; i < 2 * record.size(); ++i) {
    rows.time_s.push_back(record.time_s.front() + 0.005 * static_cast<double>(i));
    rows.torque_driver_nm.push_back(record.torque_driver_nm[i / 2]);
    rows.torque_motor_nm.push_back(record.torque_motor_nm[i / 2]);
    rows.angle_rad.push_back(record.angle_rad[i / 4 * 2]);
  }
  return rows;
}

TEST(ClockDelay, OfLessThanARowIsTheLogsWhereRowsHoldChannels) {
  const std::uint64_t seed = test::seed(366);
  Simulation simulation;
  simulation.wheel = quiet().wheel;
  test::DrawnDrive late = quiet();
  late.delay_s = 0.003;
  EXPECT_EQ(diagnose(test::drive(late, seed), simulation).verdict, "delay");
  const Diagnosis exact = diagnose(held(test::drive(late, seed)), simulation);
  EXPECT_EQ(exact.verdict, "none");
  EXPECT_TRUE(std::ranges::any_of(
      exact.notes, [](const std::string& note) { return note.starts_with("the angle comes later by 3 ms"); }));
  late.torque = [](double, double x, double) { return -150 * x * x * x; };
  const Diagnosis hardened = diagnose(held(test::drive(late, seed)), simulation);
  ASSERT_EQ(hardened.causes.size(), 1U);
  EXPECT_EQ(hardened.verdict, "cubic_stiffness");
  late.delay_s = 0.02;  // more than a row
  const Diagnosis more = diagnose(held(test::drive(late, seed)), simulation);
  EXPECT_EQ(more.causes.size(), 2U);
}

}  // namespace
}  // namespace steerid::gap
