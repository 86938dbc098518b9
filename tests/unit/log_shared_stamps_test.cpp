// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Stamps that were rounded in the test itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "log/shared_stamps.hpp"

namespace steerid {
namespace {

constexpr double kPeriod_s = 0.01;
constexpr double kStep_s = 1.0 / 64;  // single precision, two days after the clock's zero

using Rounded = std::function<double(double)>;
const Rounded kNearest = [](double of) { return std::nearbyint(of); };
const Rounded kDown = [](double of) { return std::floor(of); };

std::vector<double> steady(std::size_t count) {
  std::vector<double> time_s;
  for (std::size_t i = 0; i < count; ++i) time_s.push_back(200000.123 + kPeriod_s * static_cast<double>(i));
  return time_s;
}

std::vector<double> stamped(std::vector<double> time_s, const Rounded& rounded) {
  for (double& one : time_s) one = kStep_s * rounded(one / kStep_s);
  return time_s;
}

/// The largest difference, but for what is common to all.
double worst_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double least = INFINITY;
  double most = -INFINITY;
  for (std::size_t i = 0; i < a.size(); ++i) {
    least = std::min(least, a[i] - b[i]);
    most = std::max(most, a[i] - b[i]);
  }
  return (most - least) / 2;
}

bool increases(const std::vector<double>& time_s) {
  return std::ranges::adjacent_find(time_s, std::greater_equal()) == time_s.end();
}

TEST(SharedStamps, AreThoseOfASteadyClockWhereOneExplainsThem) {
  for (const Rounded& rounded : {kNearest, kDown}) {
    const std::vector<double> truth = steady(3000);
    std::vector<double> time_s = stamped(truth, rounded);
    EXPECT_GT(worst_difference(time_s, truth), 0.4 * kStep_s);
    const SharedStamps found = spread_shared_stamps(time_s);
    EXPECT_NEAR(static_cast<double>(found.rows), 3000 * (1 - kPeriod_s / kStep_s), 2);
    EXPECT_EQ(found.without_clock, 0);
    EXPECT_LT(worst_difference(time_s, truth), 1e-4);  // of a rounding of 4.5 ms rms, over the root of 3000, twice
  }
}

TEST(SharedStamps, AreExactWhereAsManyRowsShareEveryOne) {
  std::vector<double> time_s;
  for (int i = 0; i < 500; ++i) time_s.push_back(0.01 * (i / 5));
  EXPECT_EQ(spread_shared_stamps(time_s).without_clock, 0);
  for (std::size_t i = 0; i < time_s.size(); ++i) EXPECT_NEAR(time_s[i], 0.002 * static_cast<double>(i), 1e-12);
}

TEST(SharedStamps, AreAClocksOnEitherSideOfAGap) {
  std::vector<double> truth = steady(2000);
  for (std::size_t i = 1000; i < truth.size(); ++i) truth[i] += 7;
  std::vector<double> time_s = stamped(truth, kNearest);
  EXPECT_EQ(spread_shared_stamps(time_s).without_clock, 0);
  EXPECT_LT(worst_difference(time_s, truth), kStep_s / 2);  // where the second half lies is known to the rounding
  EXPECT_NEAR(time_s[1000] - time_s[999], 7.01, kStep_s);
}

TEST(SharedStamps, AreSpreadEvenlyWhereNoClockExplainsThem) {
  std::vector<double> lost = steady(2000);
  for (std::size_t i = 700; i < lost.size(); ++i) lost[i] += kPeriod_s;  // a row that nothing tells of
  std::vector<double> time_s = stamped(lost, kNearest);
  const std::vector<double> stamps = time_s;
  const SharedStamps found = spread_shared_stamps(time_s);
  EXPECT_GT(found.rows, 0);
  EXPECT_EQ(found.without_clock, found.rows);
  EXPECT_TRUE(increases(time_s));
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    EXPECT_GE(time_s[i], stamps[i]);
    EXPECT_LT(time_s[i], stamps[i] + 2 * kStep_s);  // there may be two to the next one
  }
}

TEST(SharedStamps, AreLeftWhereThereAreNone) {
  std::vector<double> time_s = steady(100);
  const std::vector<double> before = time_s;
  EXPECT_EQ(spread_shared_stamps(time_s).rows, 0);
  EXPECT_EQ(time_s, before);
  std::vector<double> one(50, 1.7e9);
  EXPECT_EQ(spread_shared_stamps(one).rows, 49);
  EXPECT_EQ(one, std::vector<double>(50, 1.7e9));
}

}  // namespace
}  // namespace steerid
