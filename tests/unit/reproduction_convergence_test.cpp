// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The convergence theory: predicted against measured, and what a record leaves unexcited.
#include <gtest/gtest.h>

#include <cmath>

#include "reproduction/convergence.hpp"
#include "reproduction/recording.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

const WheelArm kArm{0.11, 1.5, 22.7};

Record drive(double unmeasured_percent, bool exact, double probe_rms_nm) {
  RecordingSettings settings;
  settings.arm = kArm;
  settings.duration_s = 40;
  settings.probe_rms_nm = probe_rms_nm;
  settings.unmeasured_percent = unmeasured_percent;
  if (exact) settings.instruments = Instruments::perfect();
  settings.seed = test::seed(81);
  return make_recording(settings).record;
}

const std::vector<WheelArm> kPoor{{0.25, 0.7, 12}};

// Two ways that share the free run's sensitivities only: H by differences of the Jacobian, and steps taken.
TEST(Convergence, TheMeasuredFactorIsThatOfEquation27) {
  double largest = 0;
  for (const double percent : {0.5, 10.0}) {
    for (const double probe : {0.0, 0.5}) {
      const ConvergenceCase one = measure_convergence("", drive(percent, false, probe), kArm, kPoor);
      EXPECT_GT(one.predicted_factor, 1e-4);
      EXPECT_NEAR(one.measured_factor / one.predicted_factor, 1, 0.05) << percent << " " << probe;
      largest = std::max(largest, one.measured_factor);
    }
  }
  EXPECT_GT(largest, 0.1);  // slow convergence is among them
}

TEST(Convergence, IsQuadraticWhereTheResidualVanishes) {
  const ConvergenceCase one = measure_convergence("", drive(0, true, 0.5), kArm, kPoor);
  EXPECT_LT(one.predicted_factor, 1e-4);
  ASSERT_TRUE(one.traces[0].reached);
  EXPECT_NEAR(order_of(one.traces[0]).value_or(0), 2, 0.25);
}

TEST(Convergence, TheStepIsAlwaysOneOfDescent) {
  const ConvergenceCase one = measure_convergence("", drive(0.5, false, 0.5), kArm, kPoor);
  ASSERT_FALSE(one.traces[0].cosine.empty());
  for (const double cosine : one.traces[0].cosine) {
    EXPECT_GT(cosine, 0);  // equation 14
    EXPECT_LE(cosine, 1 + 1e-12);
  }
}

// Errors 1e-1, 1e-2, 1e-4, 1e-8: each the square of the one before. 1e-1, 1e-2, 1e-3: each a tenth.
TEST(Convergence, TheOrderIsTheSlopeOfLogarithms) {
  ConvergenceTrace trace;
  trace.distance = {1e-1, 1e-2, 1e-4, 1e-8};
  EXPECT_NEAR(order_of(trace).value_or(0), 2, 1e-9);
  trace.distance = {1e-1, 1e-2, 1e-3, 1e-4};
  EXPECT_NEAR(order_of(trace).value_or(0), 1, 1e-9);
  trace.distance = {1, 0.5};
  EXPECT_FALSE(order_of(trace));
}

TEST(Convergence, TheBasinHoldsItsMinimumAndEnds) {
  const Basin basin = draw_basin(drive(0.5, false, 0.5), kArm, 7, 1);
  EXPECT_NEAR(basin.minimum.inertia_kgm2 / kArm.inertia_kgm2, 1, 0.02);
  EXPECT_EQ(basin.unit_steps[3][3], 0);  // the middle of the grid is the minimum
  EXPECT_TRUE(std::isfinite(basin.line_search[3][3]));
  EXPECT_LT(basin.unit_share(), basin.line_search_share());
  EXPECT_LT(basin.line_search_share(), 1);
  EXPECT_NEAR(basin.inertia_kgm2.back() / basin.inertia_kgm2.front(), 900, 1e-6);
}

// A steady sine shows C - J w^2 and B w. Along the unexcited direction dC = w^2 dJ, w = 2 pi 0.4: 6.32 a unit.
TEST(Rank, ASineLeavesOneDirectionUnexcitedAndItIsNamed) {
  const RankCase sine = examine_rank("", sine_record(kArm, 0.4, 5, 20, 2e-4, test::seed(82)), kArm);
  EXPECT_EQ(sine.rank, 2);
  EXPECT_NE(sine.says.find("J is unexcited, and with it C by 6.32 Nm/rad for each kg m2 of J"), std::string::npos)
      << sine.says;
}

TEST(Rank, RestAndAConstantTorqueShowNothing) {
  const RankCase rest = examine_rank("", constant_record(kArm, 0, 30, 2e-4, test::seed(83)), kArm);
  EXPECT_EQ(rest.rank, 0);
  EXPECT_NE(rest.says.find("no direction"), std::string::npos);
  EXPECT_LT(examine_rank("", constant_record(kArm, 3, 30, 2e-4, test::seed(84)), kArm).rank, 3);
}

// A straight flank has no acceleration: J is unexcited. The corners of the whole triangle, and far more so a probe,
// show it.
TEST(Rank, AFlankOfTheTriangleLeavesTheInertiaDark) {
  const RankCase flank = examine_rank("", triangle_record(kArm, 9.5, 2e-4, test::seed(85)), kArm);
  EXPECT_LT(flank.rank, 3);
  EXPECT_EQ(flank.says.rfind("J is unexcited", 0), 0U) << flank.says;
  const RankCase triangle = examine_rank("", triangle_record(kArm, 80, 2e-4, test::seed(86)), kArm);
  const RankCase probed = examine_rank("", drive(0.5, false, 0.5), kArm);
  EXPECT_EQ(probed.rank, 3);
  EXPECT_GT(triangle.gamma, 10 * flank.gamma);
  EXPECT_GT(probed.gamma, 5 * triangle.gamma);
}

}  // namespace
}  // namespace steerid
