// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A short run of `steerid study friction`. Figures: docs/adr/0029.
#include "study/friction_study.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/seed.hpp"

namespace steerid {
namespace {

class Friction : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    found_ = run_friction_study({.drives = 6, .seed = test::seed(81)}, [](std::size_t, std::size_t) {});
  }
  static double of(const char* row, const char* key) { return found_.figure("friction", row, key); }
  inline static Findings found_;
};

TEST_F(Friction, HasEverySizeToldAndUntold) {
  ASSERT_EQ(found_.tables.size(), 1U);
  EXPECT_EQ(found_.tables[0].rows.size(), 9U);
  EXPECT_GT(of("0 Nm, no", "B_close_percent"), 20);
}

// A bearing that the task knows nothing of is damping to it, and an empty wheel is never told.
TEST_F(Friction, IsDampingToATaskThatIsNotToldOfIt) {
  EXPECT_GT(of("0.2 Nm, no", "B_wrong_of_valid_percent"), 50);
  EXPECT_LT(of("0.2 Nm, no", "nobody_told_percent"), 20);
}

TEST_F(Friction, MattersLessOnceItIsTold) {
  for (const char* size : {"0.1 Nm", "0.2 Nm"}) {
    const std::string yes = std::string(size) + ", yes", no = std::string(size) + ", no";
    EXPECT_LT(of(yes.c_str(), "B_wrong_of_valid_percent"), of(no.c_str(), "B_wrong_of_valid_percent")) << size;
    EXPECT_GT(of(yes.c_str(), "nobody_told_percent"), of(no.c_str(), "nobody_told_percent")) << size;
  }
}

}  // namespace
}  // namespace steerid
