// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// LooseFixed against exact integers of 128 bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "base/kernel_number.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

__extension__ using Wide = __int128;

/// Exact: 31 bits fit a double.
template <int N>
double real(LooseFixed<N> x) {
  return std::ldexp(x.mantissa(), x.exponent() - 29);
}

constexpr std::int32_t kMost = 1 << 29;

/// Any mantissa of N = 1, its ends and zero among them, as tight or as loose as it comes.
LooseFixed<> any(std::mt19937_64& random, int exponents) {
  constexpr std::array kEnds{0, 1, -1, kMost - 1, kMost, -kMost, kMost / 2, -kMost / 2, kMost / 2 - 1};
  const std::uint64_t chance = random();
  const auto exponent = static_cast<std::int32_t>(random() % static_cast<unsigned>(2 * exponents + 1)) - exponents;
  if (chance % 8 == 0) return {kEnds[random() % kEnds.size()], exponent};
  const auto mantissa = static_cast<std::int32_t>(random() % (2U * kMost + 1U)) - kMost;
  return {mantissa >> static_cast<int>(chance / 8 % 20), exponent};
}

TEST(LooseFixed, ProductsAreRoundedToTheNearest) {
  std::mt19937_64 random(test::seed(80));
  for (int i = 0; i < 300'000; ++i) {
    const LooseFixed<> a = any(random, 200);
    const LooseFixed<> b = any(random, 200);
    const LooseFixed<> p = a * b;
    ASSERT_EQ(p.exponent(), a.exponent() + b.exponent());
    const Wide off = (static_cast<Wide>(p.mantissa()) << 29) - static_cast<Wide>(a.mantissa()) * b.mantissa();
    ASSERT_TRUE(-(1LL << 28) <= off && off <= 1LL << 28) << real(a) << " * " << real(b);
    ASSERT_LE(std::abs(p.mantissa()), kMost);
  }
}

TEST(LooseFixed, SumsAreWithinOneUnitOfTheLargerPlace) {
  std::mt19937_64 random(test::seed(81));
  for (int i = 0; i < 300'000; ++i) {
    const LooseFixed<> a = any(random, 35);
    const LooseFixed<> b = any(random, 35);
    const LooseFixed<2> sum = i % 2 == 0 ? a + b : a - b;
    const int top = std::max(a.exponent(), b.exponent());
    ASSERT_EQ(sum.exponent(), top);
    const int low = std::min(a.exponent(), b.exponent());
    const auto at_low = [low](auto x) { return static_cast<Wide>(x.mantissa()) << (x.exponent() - low); };
    const Wide off = at_low(sum) - at_low(a) - (i % 2 == 0 ? at_low(b) : -at_low(b));
    ASSERT_TRUE(off <= 0 && -off < Wide{1} << (top - low)) << real(a) << ' ' << real(b);
  }
  // Rounded: the same within half a unit either way.
  for (int i = 0; i < 300'000; ++i) {
    const LooseFixed<> a = any(random, 35);
    const LooseFixed<> b = any(random, 35);
    const LooseFixed<2> sum = rounded_sum(a, b);
    const int low = std::min(a.exponent(), b.exponent());
    const auto at_low = [low](auto x) { return static_cast<Wide>(x.mantissa()) << (x.exponent() - low); };
    const Wide off = 2 * (at_low(sum) - at_low(a) - at_low(b));
    const Wide unit = Wide{1} << (sum.exponent() - low);
    ASSERT_TRUE(-unit <= off && off <= unit) << real(a) << ' ' << real(b);
  }
  // Far apart, and three of the largest: the type has room for them.
  const LooseFixed<> most(kMost, 3);
  EXPECT_EQ(real(most + LooseFixed<>(kMost, -1000)), 8.0);
  EXPECT_EQ(real(most + LooseFixed<>()), 8.0);
  EXPECT_EQ(real(LooseFixed<>() + most), 8.0);
  EXPECT_EQ(real(most + most + most), 24.0);
  EXPECT_EQ(real(-most - most - most), -24.0);
}

TEST(LooseFixed, TightKeepsTheValueToHalfAUnit) {
  std::mt19937_64 random(test::seed(82));
  for (int i = 0; i < 300'000; ++i) {
    const LooseFixed<3> x = LooseFixed<2>(any(random, 0)) + any(random, 3);
    const LooseFixed<> t = tight(x);
    if (x.mantissa() > 0) {
      ASSERT_EQ(tight_positive(x).mantissa(), t.mantissa());
      ASSERT_EQ(tight_positive(x).exponent(), t.exponent());
    }
    if (x.mantissa() == 0) {
      ASSERT_EQ(t.mantissa(), 0);
      continue;
    }
    ASSERT_TRUE(std::abs(t.mantissa()) >= kMost / 2 && std::abs(t.mantissa()) <= kMost);
    ASSERT_LE(std::abs(real(t) - real(x)), std::ldexp(0.5, t.exponent() - 29)) << x.mantissa() << " 2^" << x.exponent();
  }
  const LooseFixed<> most(kMost, 0);
  EXPECT_EQ(real(tight(most)), 1.0);
  EXPECT_EQ(real(tight(-most)), -1.0);
}

TEST(LooseFixed, ReciprocalsAreWithinThreeUnits) {
  std::mt19937_64 random(test::seed(83));
  double worst = 0;
  for (int i = 0; i < 300'000; ++i) {
    const auto exponent = static_cast<int>(random() % 100) - 50;
    const std::int32_t mantissa = i < 100   ? kMost / 2 + i
                                  : i < 200 ? kMost - i + 100
                                            : kMost / 2 + static_cast<std::int32_t>(random() % (kMost / 2));
    const LooseFixed<> x(mantissa, exponent);
    const LooseFixed<> inverse = reciprocal_of(x);
    ASSERT_TRUE(inverse.mantissa() >= kMost / 2 - 3 && inverse.mantissa() <= kMost);
    // Two numbers of 30 bits: the product is exact in 64 and its distance from one in a double.
    const std::int64_t product = static_cast<std::int64_t>(inverse.mantissa()) * mantissa;  // of 2^57
    ASSERT_EQ(inverse.exponent(), 1 - exponent);
    worst = std::max(worst, std::abs(std::ldexp(static_cast<double>(product - (1LL << 57)), -57)));
  }
  EXPECT_LE(worst, std::ldexp(1.0, -27));
  EXPECT_GE(worst, std::ldexp(1.0, -30));
}

TEST(LooseFixed, ComesFromFixedAndGoesBackUnchanged) {
  for (const Fixed x : {Fixed(), Fixed(1), Fixed(-3), Fixed(0.1), Fixed(1e-30), Fixed::largest(), -Fixed::largest()}) {
    EXPECT_EQ(Fixed(LooseFixed<>(x)), x);
  }
  // Beyond Fixed's range it is held and counted.
  Fixed::clear_overflow_count();
  EXPECT_EQ(Fixed(LooseFixed<>(kMost, 500)), Fixed::largest());
  EXPECT_EQ(Fixed::overflow_count(), 1U);
  EXPECT_EQ(Fixed(LooseFixed<>(kMost, -500)), Fixed());
  EXPECT_EQ(Fixed(LooseFixed<>(0, 500)), Fixed());
  Fixed::clear_overflow_count();
}

TEST(LooseFixed, ShiftsAreHeldToWhatAProcessorCanDo) {
  EXPECT_EQ(fixed_detail::held_to_31(-1), 0);
  EXPECT_EQ(fixed_detail::held_to_31(31), 31);
  EXPECT_EQ(fixed_detail::held_to_31(32), 31);
}

TEST(KernelNumber, OfAFloatIsTheFloat) {
  static_assert(std::is_same_v<KernelNumber<float>, float> && std::is_same_v<KernelNumber<double>, double>);
  EXPECT_EQ(tight(0.1F), 0.1F);
  EXPECT_EQ(tight(0.1), 0.1);
  EXPECT_EQ(tight_positive(0.1F), 0.1F);
  EXPECT_EQ(tight_positive(0.1), 0.1);
  EXPECT_EQ(rounded_sum(0.1F, 0.2F), 0.1F + 0.2F);
  EXPECT_EQ(rounded_sum(0.1, 0.2), 0.1 + 0.2);
  EXPECT_EQ(reciprocal_of(3.0F), 1.0F / 3.0F);
  EXPECT_EQ(reciprocal_of(3.0), 1.0 / 3.0);
}

}  // namespace
}  // namespace steerid
