// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study uncertainty`: whether the recursive identifier's deviations are deviations, with torque
// that no sensor sees. 60 drives a case. Limits: docs/testing.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "study/study.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

// The mean of 60 chi-squares with three degrees of freedom has a standard deviation of sqrt(6/60) = 0.32; three of
// them beyond the limits of a mean of 500, which is what is asked. Twice the variance would leave 1.5, half of it 6.
// Coverage: of 60 drives 97 % and 93 % have a standard deviation of 2.2 and 3.3 %.
TEST(Uncertainty, HoldsWithTorqueThatNoSensorSees) {
  StudyPlan plan = uncertainty_study();
  plan.methods = {Method::kRecursiveFloat};
  std::erase_if(plan.cases, [](const StudyCase& one) { return one.drive.unmeasured_torque_nm == 0; });
  ASSERT_EQ(plan.cases.size(), 9U);  // three arms with 2 and 10 %, and behind one low pass
  const StudyResult result = run_study(plan, 60, test::seed(1));
  for (const CaseResult& one : result.cases) {
    const MethodScore& score = one.scores[0];
    SCOPED_TRACE(fmt::format("{}, {}", one.what.wheel, one.what.noise));
    ASSERT_TRUE(score.nees.has_value());
    EXPECT_GT(*score.nees, 2.79 - 3 * 0.32);
    EXPECT_LT(*score.nees, 3.22 + 3 * 0.32);
    for (const ParameterScore& parameter : score.parameters) {
      ASSERT_TRUE(parameter.coverage.has_value());
      EXPECT_GT(*parameter.coverage, 0.93 - 3 * 0.033);
    }
  }
}

}  // namespace
}  // namespace steerid
