// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study closed_loop`: what feedback does to the estimate, with and without a probe.
#include <gtest/gtest.h>

#include <cmath>

#include "study/closed_loop.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

const ClosedLoopResult& of(const ClosedLoopStudy& study, double gain, double unmeasured_nm, double probe_rms_nm) {
  for (const ClosedLoopResult& one : study.results) {
    if (one.what.gain == gain && one.what.unmeasured_nm == unmeasured_nm && one.what.probe_rms_nm == probe_rms_nm) {
      return one;
    }
  }
  throw std::logic_error("no such case");
}

class ClosedLoop : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    study_ = run_closed_loop_study(10, test::seed(71), [](std::size_t) {});
  }
  inline static ClosedLoopStudy study_;
};

TEST_F(ClosedLoop, TheProbeAsInstrumentHasNoBias) {
  for (const ClosedLoopResult& one : study_.results) {
    if (!(one.what.probe_rms_nm > 0)) continue;
    for (int i = 0; i < 3; ++i) {
      // The standard error is itself known to a quarter with ten drives: five of them, in some thirty comparisons.
      EXPECT_LT(std::abs(one.probe.percent(i)), 5 * one.probe.error_percent(i) + 0.05)
          << one.what.name << " " << one.what.unmeasured_nm << " " << one.what.probe_rms_nm << " " << i;
      EXPECT_GT(one.probe.error_percent(i), 0);
    }
  }
}

// Of 60 seeds (101 to 160) feedback moves the mean of ten drives by 0.05 % at most, and the bias is 0.13 % at most:
// twice the former, and what docs/testing.md states of the latter.
TEST_F(ClosedLoop, UnderAProbeFeedbackMovesTheFirmwaresAnswerByLessThanATenthOfAPercent) {
  for (const double unmeasured_nm : {0.0, 0.05, 0.15}) {
    const ClosedLoopResult& open = of(study_, 0, unmeasured_nm, 1.5);
    const ClosedLoopResult& closed = of(study_, 10, unmeasured_nm, 1.5);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(closed.recursive.percent(i) - open.recursive.percent(i)), 0.1) << unmeasured_nm << " " << i;
      EXPECT_LT(std::abs(closed.recursive.percent(i)), 0.2) << unmeasured_nm << " " << i;
      EXPECT_LT(std::abs(open.recursive.percent(i)), 0.2) << unmeasured_nm << " " << i;
      EXPECT_NEAR(closed.valid_share(i), 1.0, 1e-9);
    }
  }
}

// A driver's slow course does not show J: in most drives it keeps the value that the search starts from, 0.08 kg m2 for
// this arm's 0.11, which is 27.3 % too low. Of 60 seeds (101 to 160) the mean of ten drives is 10 to 34 % too low. With
// 40 of these seeds three of 2400 drives without a probe end with J valid.
TEST_F(ClosedLoop, WithoutAProbeJIsNotShown) {
  const ClosedLoopResult& closed = of(study_, 10, 0.15, 0.0);
  EXPECT_LT(closed.recursive.percent(0), -5);
  EXPECT_GT(closed.recursive.percent(0), -40);
  EXPECT_LE(closed.valid_share(0), 0.1);
}

}  // namespace
}  // namespace steerid
