// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The loop over a motion that is known, against closed forms: with n = 1 what is missing to 1 falls off exponentially;
// with n = 2 it is a tangent while z is undone and a hyperbolic tangent while it is built up.
#include "gap/hypotheses/hysteresis_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "support/seed.hpp"

namespace steerid::gap {
namespace {

double with_one(double z, double gone) { return 1 - (1 - z) * std::exp(-gone); }

double with_two(double z, double gone) {
  if (z >= 0) return std::tanh(std::atanh(std::min(z, 1 - 1e-15)) + gone);
  const double undone = std::tan(std::min(std::atan(z) + gone, 0.0));
  return undone < 0 ? undone : std::tanh(gone + std::atan(z));
}

/// The largest difference over a motion of steps between 1e-5 and 1 that turns round one time in `turns`.
double largest_difference(double sharpness, const std::function<double(double, double)>& closed_form, int turns) {
  std::mt19937_64 engine(test::seed(61));
  HysteresisLoop loop(sharpness);
  double z = 0;
  int way = 1;
  double largest = 0;
  for (int i = 0; i < 20000; ++i) {
    const double share = 0x1p-53 * static_cast<double>(engine() >> 11U);
    const double gone = std::pow(10, -5 * share);
    if (engine() % static_cast<unsigned>(turns) == 0) way = -way;
    z = way * closed_form(way * z, gone);
    largest = std::max(largest, std::abs(loop.advance(way * gone) - z));
  }
  return largest;
}

TEST(HysteresisLoop, GoesAlongTheClosedForms) {
  for (const int turns : {2, 20}) {
    // The curve ends 1e-5 below 1; what is missing to 1 is doubled where the way turns round.
    EXPECT_LT(largest_difference(1, with_one, turns), 3e-5);
    EXPECT_LT(largest_difference(2, with_two, turns), 3e-5);
    EXPECT_GT(largest_difference(2, with_one, turns), 0.01) << "the two are alike";
  }
}

/// A step of nothing is no turn, whatever its sign.
TEST(HysteresisLoop, StaysWhereNothingMoves) {
  HysteresisLoop loop(1.7);
  const double there = loop.advance(-0.3);
  EXPECT_LT(there, -0.2);
  EXPECT_EQ(loop.advance(0.0), there);
  EXPECT_EQ(loop.advance(-0.0), there);
}

}  // namespace
}  // namespace steerid::gap
