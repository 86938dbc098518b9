// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe in the loop: it makes the unexcited inertia visible, and asks for nothing unless it is permitted.
#include "app/probe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "app/run_loop.hpp"
#include "backend/simulated.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// A driver who holds the wheel still: nothing but a probe can show the arm.
Scenario quiet(std::uint64_t seed, bool granted) {
  Scenario s;
  s.task = task_settings(TaskKind::kProbe, HandPosition::kRight3, seed);
  s.task.probe.rms_nm = 0;
  s.wheel = s.task.arm;
  s.duration_s = 40;
  s.grant_probe_requests = granted;
  return s;
}

TEST(ProbeInTheLoop, MakesTheInertiaVisible) {
  const std::uint64_t seed = test::seed(81);
  for (std::uint64_t i = 0; i < 10; ++i) {
    SimulatedHal hal(quiet(seed + i, true));
    IdentificationTask<float> task;
    task.permit_probe(true);
    ASSERT_EQ(run_loop(hal, task), Status::kOk);
    const float inertia = task.identifier().value()(kInertia);
    // The probe stops as soon as every parameter is valid, which is at a standard deviation of 10 %.
    EXPECT_NEAR(inertia, 0.11F, 0.033F) << i;
    EXPECT_LT(task.identifier().standard_deviation()(kInertia), 0.011F) << i;
  }
}

TEST(ProbeInTheLoop, AsksForNothingUnlessPermitted) {
  SimulatedDrive drive;
  SimulatedHal hal(quiet(test::seed(82), true), &drive);
  IdentificationTask<float> task;
  ASSERT_EQ(run_loop(hal, task), Status::kOk);
  ASSERT_EQ(drive.truth.torque_motor_nm.size(), 4000U);  // 40 s
  EXPECT_TRUE(std::ranges::all_of(drive.truth.torque_motor_nm, [](double t) { return t == 0.0; }));
}

}  // namespace
}  // namespace steerid
