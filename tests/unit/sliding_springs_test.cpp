// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Springs with sliders against what they are made of: thousands of them, each a number that is clipped.
#include "plant/effects/sliding_springs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "support/seed.hpp"

namespace steerid::test {
namespace {

using effect::SlidingSprings;

/// The sum over springs that slip at 0 to 16: as stiff as -f'' at where they slip.
class Sum {
 public:
  explicit Sum(const std::function<double(double)>& stiffness) {
    for (std::size_t i = 0; i < kSprings; ++i) {
      slips_at_[i] = kWidth * (static_cast<double>(i) + 0.5);
      stiffness_[i] = kWidth * stiffness(slips_at_[i]);
    }
  }
  double go(double place) {
    double sum = 0;
    for (std::size_t i = 0; i < kSprings; ++i) {
      bend_[i] = std::clamp(bend_[i] + place - place_, -slips_at_[i], slips_at_[i]);
      sum += stiffness_[i] * bend_[i];
    }
    place_ = place;
    return sum;
  }

 private:
  static constexpr std::size_t kSprings = 8000;
  static constexpr double kWidth = 16.0 / kSprings;
  std::vector<double> slips_at_ = std::vector<double>(kSprings);
  std::vector<double> stiffness_ = std::vector<double>(kSprings);
  std::vector<double> bend_ = std::vector<double>(kSprings);
  double place_ = 0;
};

/// The largest difference over a motion that turns round at places drawn from small to large.
double largest_difference(SlidingSprings springs, Sum sum) {
  std::mt19937_64 engine(test::seed(62));
  std::uniform_real_distribution<double> share(0, 1);
  double place = 0;
  double largest = 0;
  for (int turn = 0; turn < 400; ++turn) {
    const double target = std::pow(10, 1.5 * share(engine) - 1) * (share(engine) < 0.5 ? -1 : 1);
    const int way = target < place ? -1 : 1;
    const double from = place;
    for (int k = 1; k <= 4; ++k) {
      place = from + (target - from) * k / 4;
      const double expected = sum.go(place);
      largest = std::max({largest, std::abs(springs.at(place, way) - expected)});
      largest = std::max(largest, std::abs(springs.go(place, way) - expected));
    }
  }
  return largest;
}

TEST(SlidingSprings, AreASumOfSprings) {
  // f = 1 - exp(-s) for n = 1, tanh(s) for n = 2.
  const auto exponential = [](double s) { return std::exp(-s); };
  const auto tangent = [](double s) { return 2 * std::tanh(s) / std::pow(std::cosh(s), 2); };
  // Springs 2e-3 apart miss 1e-6 of a sum, the table's cubics 1e-7, and its end 1e-6, twice.
  constexpr double kLargest = 1e-5;
  EXPECT_LT(largest_difference(SlidingSprings(1), Sum(exponential)), kLargest);
  EXPECT_LT(largest_difference(SlidingSprings(2), Sum(tangent)), kLargest);
  EXPECT_GT(largest_difference(SlidingSprings(2), Sum(exponential)), 0.05) << "the two are alike";
}

TEST(SlidingSprings, ForgetDetours) {
  SlidingSprings straight(1.5);
  SlidingSprings detoured(1.5);
  for (const double place : {0.7, -0.4}) straight.go(place, place < 0 ? -1 : 1);
  detoured.go(0.7, 1);
  detoured.go(0.1, -1);
  detoured.go(0.5, 1);
  detoured.go(0.3, -1);
  detoured.go(0.45, 1);
  EXPECT_DOUBLE_EQ(detoured.go(-0.4, -1), straight.here());
  EXPECT_DOUBLE_EQ(detoured.go(-0.9, -1), straight.go(-0.9, -1)) << "beyond where it turned first";
}

TEST(SlidingSprings, StayWhereNothingMoves) {
  SlidingSprings springs(1.7);
  const double there = springs.go(-0.3, -1);
  EXPECT_LT(there, -0.2);
  EXPECT_DOUBLE_EQ(springs.at(-0.3, -1), there);
  EXPECT_DOUBLE_EQ(springs.at(-0.3, 1), there);
}

}  // namespace
}  // namespace steerid::test
