// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction above the torsion bar, on a column of an integrator of its own: its size from a record with the hands
// off, and what an arm's B is worth with and without it.
#include <gtest/gtest.h>

#include <random>

#include "fit/wheel_friction.hpp"
#include "support/seed.hpp"
#include "support/steered_column.hpp"

namespace steerid {
namespace {

constexpr double kForEver = 1e9;
constexpr test::SteeredColumn kHeld{.intent_rad = 0.05, .probe_nm = 1};
constexpr test::SteeredColumn kEmpty{.probe_nm = 1, .let_go_from_s = 0, .let_go_for_s = kForEver};

Record record_of(test::SteeredColumn column, double wheel_friction_nm, double duration_s, std::uint64_t seed) {
  column.wheel_friction_nm = wheel_friction_nm;
  std::mt19937_64 random(seed);
  Record record;
  record.channels = kAngleValid | kTorqueBarValid | kProbeValid;
  for (const test::ColumnRow& row : test::drive(column, duration_s, random)) {
    record.time_s.push_back(0.01 * static_cast<double>(record.size()));
    record.angle_rad.push_back(row.angle_rad);
    record.torque_bar_nm.push_back(row.bar_nm);
    record.probe_nm.push_back(row.probe_nm);
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(0);
  }
  return record;
}

TEST(WheelFriction, IsFoundWithTheHandsOff) {
  const std::uint64_t seed = test::seed(300);
  for (const double friction_nm : {0.05, 0.1, 0.2}) {
    SCOPED_TRACE(friction_nm);
    const Record record = record_of(kEmpty, friction_nm, 40, seed);
    const auto found = fit_bare_wheel(record);
    ASSERT_TRUE(found);
    // Over seeds 1 to 20 F is 1.02 to 1.12 times the true one and J 0.99 to 1.08 times.
    EXPECT_NEAR(found->friction.value, friction_nm, 0.2 * friction_nm);
    EXPECT_NEAR(found->wheel.inertia.value, 0.035, 0.2 * 0.035);
    // What friction puts on the damping of a fit that knows of none.
    const double as_damping = fit_by_instrument(record).damping.value - 0.06;
    EXPECT_GT(as_damping, 2 * friction_nm);
    EXPECT_NEAR(found->wheel.damping.value, 0.06, 0.2 * as_damping);
  }
}

// Within 2.5 s a wheel that sticks most of the time may show neither.
TEST(WheelFriction, IsNotToldWithoutTheInertia) {
  const std::uint64_t first = test::seed(310);
  int told = 0;
  int without = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const auto found = fit_bare_wheel(record_of(kEmpty, 0.3, 2.5, first + i));
    if (!found) ++without;
    if (!found) continue;
    ++told;
    EXPECT_EQ(found->wheel.inertia.state, ParameterState::kValid) << i;
  }
  EXPECT_GT(told, 0);
  EXPECT_GT(without, 0);
}

TEST(WheelFriction, IsNoneWhereThereIsNoneOrWhereSomebodyHoldsTheWheel) {
  const std::uint64_t seed = test::seed(301);
  // What the evidence takes for friction by chance, in 3 of 60 drives, is 2 to 3.5 mNm.
  const auto by_chance = fit_bare_wheel(record_of(kEmpty, 0, 40, seed));
  EXPECT_LT(by_chance ? by_chance->friction.value : 0.0, 0.005);
  for (const double friction_nm : {0.0, 0.1}) EXPECT_FALSE(fit_bare_wheel(record_of(kHeld, friction_nm, 40, seed)));
  Record none;
  none.channels = kAngleValid | kTorqueBarValid;
  EXPECT_FALSE(fit_bare_wheel(none));
  Record other = record_of(kEmpty, 0.1, 40, seed);
  other.channels = kAngleValid | kTorqueDriverValid | kTorqueMotorValid;
  EXPECT_FALSE(fit_bare_wheel(other));
  EXPECT_EQ(less_wheel_friction(other, 0.1).torque_bar_nm, other.torque_bar_nm);
}

TEST(WheelFriction, TakenOffTheBarLeavesTheArmsDamping) {
  const std::uint64_t seed = test::seed(302);
  for (const double friction_nm : {0.05, 0.1}) {
    SCOPED_TRACE(friction_nm);
    const Record record = record_of(kHeld, friction_nm, 60, seed);
    const InstrumentalFit with = fit_by_instrument(record);
    const InstrumentalFit without = fit_by_instrument(less_wheel_friction(record, friction_nm));
    EXPECT_NEAR(without.inertia.value, kHeld.inertia_kgm2, 0.08 * kHeld.inertia_kgm2);
    EXPECT_NEAR(without.damping.value, kHeld.damping_nms_per_rad, 0.1 * kHeld.damping_nms_per_rad);
    EXPECT_GT(with.damping.value, (1 + 2.5 * friction_nm) * kHeld.damping_nms_per_rad);
  }
}

}  // namespace
}  // namespace steerid
