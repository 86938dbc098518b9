// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study probe`. Limits: docs/testing.md.
#include "study/probe_study.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/seed.hpp"

namespace steerid {
namespace {

class ProbeOfTheTask : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    found_ = run_probe_study({.drives = 2, .seed = test::seed(1)}, [](std::size_t, std::size_t) {});
  }
  inline static Findings found_;
};

// It is smaller than the flat one of 1 Nm, and it is there; of the same size the hand feels lines of 2 to 4 and 5.5 Hz
// as much as a flat one, within a tenth (docs/column.md).
TEST_F(ProbeOfTheTask, CostsLessThanAFlatOneThatIsAlwaysThere) {
  for (const char* steers : {"0 rad", "0.03 rad", "0.1 rad", "0.2 rad"}) {
    const auto of = [&](const char* probe, const char* key) {
      return found_.figure("probe", std::string(steers) + ", " + probe, key);
    };
    EXPECT_LT(of("the task's own", "asked_nm"), of("flat, 1 Nm", "asked_nm")) << steers;
    EXPECT_LT(of("the task's own", "felt_nm"), 1.1 * of("flat, 1 Nm", "felt_nm")) << steers;
    EXPECT_GT(of("the task's own", "asked_nm"), 0.1) << steers;
    EXPECT_NEAR(of("flat, 1 Nm", "asked_nm"), 1, 0.02) << steers;
  }
}

// Wrong though valid by more than the interval and a tenth: the design's 2 % of all drives, five times as much of two.
TEST_F(ProbeOfTheTask, StaysAnInstrumentHoweverItIsDelivered) {
  for (const char* delivered : {"as asked", "5 ms late", "15 ms late", "30 ms late", "half of it",
                                "clipped: motor of 1.5 Nm", "30 ms late, 0.7 of it, motor of 2 Nm"}) {
    for (const char* wrong : {"J_wrong_percent", "B_wrong_percent", "C_wrong_percent"})
      EXPECT_LT(found_.figure("delivered", delivered, wrong), 10) << delivered << " " << wrong;
    EXPECT_GT(found_.figure("delivered", delivered, "J_close_percent"), 30) << delivered;
  }
}

}  // namespace
}  // namespace steerid
