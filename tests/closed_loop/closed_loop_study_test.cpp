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

TEST_F(ClosedLoop, UnderAProbeFeedbackMovesTheFirmwaresAnswerByLessThanOnePercent) {
  for (const double unmeasured_nm : {0.0, 0.05, 0.15}) {
    const ClosedLoopResult& open = of(study_, 0, unmeasured_nm, 1.5);
    const ClosedLoopResult& closed = of(study_, 10, unmeasured_nm, 1.5);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(closed.recursive.percent(i) - open.recursive.percent(i)), 1.0) << unmeasured_nm << " " << i;
      EXPECT_NEAR(closed.valid_share(i), 1.0, 1e-9);
    }
  }
}

TEST_F(ClosedLoop, WithoutAProbeTheUnmeasuredTorqueIsNotRemoved) {
  // A driver's slow course shows little of J: what remains is far above what a probe leaves, and nothing takes it away.
  const ClosedLoopResult& closed = of(study_, 10, 0.15, 0.0);
  const ClosedLoopResult& probed = of(study_, 10, 0.15, 1.5);
  EXPECT_GT(std::abs(closed.recursive.percent(0)), 5 * std::abs(probed.recursive.percent(0)));
}

}  // namespace
}  // namespace steerid
