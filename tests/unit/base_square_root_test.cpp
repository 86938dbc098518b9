// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The square root against the C library's, which the firmware does not link.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "base/square_root.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

template <class Float, class Bits>
std::int64_t largest_distance_in_ulp(std::uint64_t seed) {
  constexpr int kMantissaBits = std::numeric_limits<Float>::digits - 1;
  constexpr Bits kExponents = (Bits{1} << (sizeof(Float) * 8 - 1 - kMantissaBits)) - 1;
  constexpr Bits kMantissa = (Bits{1} << kMantissaBits) - 1;
  std::mt19937_64 random(seed);
  std::int64_t worst = 0;
  for (Bits exponent = 1; exponent < kExponents; ++exponent) {
    for (int i = 0; i < 500; ++i) {
      // Both ends of every binade, and chance between.
      const Bits mantissa = i == 0 ? 0 : i == 1 ? kMantissa : static_cast<Bits>(random()) & kMantissa;
      const auto x = std::bit_cast<Float>(static_cast<Bits>((exponent << kMantissaBits) | mantissa));
      const auto ours = static_cast<std::int64_t>(std::bit_cast<Bits>(square_root(x)));
      const auto exact = static_cast<std::int64_t>(std::bit_cast<Bits>(std::sqrt(x)));
      worst = std::max(worst, std::abs(ours - exact));
    }
  }
  return worst;
}

/// The iteration where the processor's root is not there.
template <class Float>
double worst_of_the_iteration(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  double worst = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto x = static_cast<Float>(
        std::ldexp(1.0 + 0x1p-53 * static_cast<double>(random() >> 11U), static_cast<int>(random() % 240) - 120));
    const Float exact = std::sqrt(x);
    const Float unit = std::nextafter(exact, Float(2) * exact) - exact;
    worst = std::max(worst, static_cast<double>(std::abs(square_root_detail::by_iteration(x) - exact) / unit));
  }
  return worst;
}

TEST(SquareRoot, TheIterationIsWithinOneUnitInTheLastPlace) {
  EXPECT_LE(worst_of_the_iteration<float>(test::seed(3)), 1);
  EXPECT_LE(worst_of_the_iteration<double>(test::seed(4)), 1);
}

// Half a unit to either side squared, exact in double, lies to either side of the argument.
TEST(SquareRoot, InFloatIsTheRoundedTrueRoot) {
  std::mt19937_64 random(test::seed(5));
  for (int i = 0; i < 200'000; ++i) {
    const auto x = static_cast<float>(1.0 + 3.0 * 0x1p-53 * static_cast<double>(random() >> 11U));
    const double root = static_cast<double>(square_root(x));
    const double below = root - 0x1p-24;
    const double above = root + 0x1p-24;
    ASSERT_LT(below * below, static_cast<double>(x));
    ASSERT_GT(above * above, static_cast<double>(x));
  }
}

TEST(SquareRoot, IsWithinOneUnitInTheLastPlaceAtEveryExponent) {
  EXPECT_LE((largest_distance_in_ulp<float, std::uint32_t>(test::seed(1))), 1);
  EXPECT_LE((largest_distance_in_ulp<double, std::uint64_t>(test::seed(2))), 1);
}

template <class Float>
class SquareRootOf : public ::testing::Test {};
using Floats = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SquareRootOf, Floats);

TYPED_TEST(SquareRootOf, WhatHasNoRootIsZero) {
  using Limits = std::numeric_limits<TypeParam>;
  EXPECT_EQ(square_root(TypeParam(0)), TypeParam(0));
  EXPECT_EQ(square_root(-TypeParam(0)), TypeParam(0));
  EXPECT_EQ(square_root(TypeParam(-4)), TypeParam(0));
  EXPECT_EQ(square_root(-Limits::infinity()), TypeParam(0));
  EXPECT_EQ(square_root(Limits::quiet_NaN()), TypeParam(0));
}

TYPED_TEST(SquareRootOf, SubnormalNumbersCountAsZero) {
  using Limits = std::numeric_limits<TypeParam>;
  EXPECT_EQ(square_root(Limits::denorm_min()), TypeParam(0));
  EXPECT_EQ(square_root(std::nextafter(Limits::min(), TypeParam(0))), TypeParam(0));
  EXPECT_GT(square_root(Limits::min()), TypeParam(0));
}

TYPED_TEST(SquareRootOf, WorksUpToTheLargestNumber) {
  using Limits = std::numeric_limits<TypeParam>;
  EXPECT_NEAR(square_root(Limits::max()) / std::sqrt(Limits::max()), TypeParam(1), 2 * Limits::epsilon());
  static_assert(square_root(TypeParam(9)) == TypeParam(3));
}

}  // namespace
}  // namespace steerid
