// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "report/thin.hpp"
#include "support/seed.hpp"

namespace steerid::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> ramp(std::size_t count) {
  std::vector<double> x(count);
  for (std::size_t i = 0; i < count; ++i) x[i] = static_cast<double>(i);
  return x;
}

TEST(Thin, KeepsEverythingThatIsShort) {
  const std::vector<double> x = ramp(5);
  EXPECT_EQ(thinned(x, x, 5), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(thinned({}, {}, 5).empty());
}

// Six points to four: two buckets of two. By hand, from (0,0) with the mean of the next bucket (3.5, 0) the triangle of
// (2, 9) is 3.5 * 9 / 2 and that of (1, 1) is 3.5 / 2; from (2, 9) with the last point (5, 0), (3, 0) spans
// |(2-5)(0-9) - (2-3)(0-9)| / 2 = 9 and (4, 0) spans |(2-5)(0-9) - (2-4)(0-9)| / 2 = 4.5.
TEST(Thin, ChoosesTheLargestTriangle) {
  const std::vector<double> y = {0, 1, 9, 0, 0, 0};
  EXPECT_EQ(thinned(ramp(6), y, 4), (std::vector<std::size_t>{0, 2, 3, 5}));
}

TEST(Thin, KeepsEndsOrderCountAndTheOneSpike) {
  std::mt19937_64 random(test::seed(11));
  for (int run = 0; run < 50; ++run) {
    const std::size_t count = 100 + random() % 5000;
    const std::size_t keep = 3 + random() % 97;
    std::vector<double> y(count, 0.0);
    const std::size_t spike = 1 + random() % (count - 2);
    y[spike] = run % 2 == 0 ? 5.0 : -5.0;
    const auto kept = thinned(ramp(count), y, keep);
    ASSERT_EQ(kept.size(), keep);
    EXPECT_EQ(kept.front(), 0U);
    EXPECT_EQ(kept.back(), count - 1);
    EXPECT_TRUE(std::adjacent_find(kept.begin(), kept.end(), std::greater_equal<>{}) == kept.end());
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), spike));
  }
}

TEST(Thin, KeepsALongGapAndClosesScatteredOnes) {
  std::vector<double> y(10'000, 1.0);
  for (std::size_t i = 4000; i < 5000; ++i) y[i] = kNan;
  for (std::size_t i = 6003; i < 9000; i += 20) y[i] = kNan;
  const auto kept = thinned(ramp(y.size()), y, 1002);  // buckets of ten
  const auto gaps = [&](std::size_t from, std::size_t to) {
    return std::count_if(kept.begin(), kept.end(),
                         [&](std::size_t i) { return i >= from && i < to && std::isnan(y[i]); });
  };
  EXPECT_NEAR(static_cast<double>(gaps(4000, 5000)), 100, 1);
  EXPECT_EQ(gaps(6000, 9000), 0);
}

}  // namespace
}  // namespace steerid::report
