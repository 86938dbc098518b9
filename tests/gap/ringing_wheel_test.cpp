// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel that rings for seconds: what its run says of a fit whose blocks leave the damping open.
#include <gtest/gtest.h>

#include "gap/attribution/what_is_left.hpp"
#include "gap/compared_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// Of a candidate whose damping is a fifth off, known to `damping_sd`.
double run_error(const test::ComparedDrive& compared, double damping_sd) {
  ComparisonSetting setting = compared.setting;
  setting.closest.stiffness_nm_per_rad *= 1.01;  // without the effect the wheel is elsewhere
  Effect reflex(effect::reflex);
  reflex.at("reflex_stiffness_nm_per_rad") = 1e-3;  // next to none: the drive has none
  const ComparedParts there = compared_parts({});
  Candidate one = compared.candidate(there, "reflex", reflex, kSeen);
  one.fit.x[1] *= 1.2;
  constexpr double kKnown = 1e12;
  one.fit.information = kKnown * Eigen::MatrixXd::Identity(one.fit.x.size(), one.fit.x.size());
  one.fit.information(1, 1) = 1 / (damping_sd * damping_sd);
  note_run(setting, there, one);
  return one.run_error.value_or(0);
}

TEST(RingingWheel, ARunContradictsOnlyWhatTheBlocksKnow) {
  // A damping ratio of 4 %: it rings for 2 s, at 1.9 Hz.
  const test::ComparedDrive compared({.wheel = {0.071, 0.07, 10}, .probe_rms_nm = 0.6}, test::seed(110));
  const double off = 0.2 * compared.drive.wheel.damping_nms_per_rad;
  // 0.4 leaves a fit half unknown (docs/gap_method.md). None of 41 seeds fails on either side.
  EXPECT_GT(run_error(compared, 0.1 * off), 0.4);
  EXPECT_LT(run_error(compared, 3 * off), 0.4);
}

}  // namespace
}  // namespace steerid
