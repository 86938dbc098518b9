// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Fixed against exact integers of 128 bits: every operation at the extremes of its operands and at chance ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "base/fixed.hpp"
#include "support/property.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

__extension__ using Wide = __int128;

constexpr int kLeast = Fixed::kLeastExponent;
constexpr int kMost = Fixed::kMostExponent;

Fixed make(std::int64_t mantissa, int exponent) { return Fixed::scaled(mantissa, exponent); }
/// Exact: 29 bits fit a double, and the range is far inside its.
double real(Fixed x) { return std::ldexp(x.mantissa(), x.exponent()); }
/// One unit in the last place of a result of that size.
double unit(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, exponent - 1 - Fixed::kFractionBits);
}
bool proper(Fixed x) {
  if (x.mantissa() == 0) return real(x) == 0 && x == Fixed() && x.exponent() < kLeast;
  const int size = std::abs(x.mantissa());
  return size >= Fixed::kLeastMantissa && size <= Fixed::kMostMantissa && x.exponent() >= kLeast &&
         x.exponent() <= kMost;
}

/// Zero, both ends of the mantissa and their neighbours, the middle, and chance; of both signs, at the given exponents.
std::vector<Fixed> operands(const std::vector<int>& exponents, int chance, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Fixed> all{Fixed()};
  for (const int exponent : exponents) {
    std::vector<std::int64_t> mantissas{Fixed::kLeastMantissa, Fixed::kLeastMantissa + 1, Fixed::kLeastMantissa * 3 / 2,
                                        Fixed::kMostMantissa - 1, Fixed::kMostMantissa};
    for (int i = 0; i < chance; ++i) {
      mantissas.push_back(Fixed::kLeastMantissa + static_cast<std::int64_t>(random() % Fixed::kLeastMantissa));
    }
    for (const std::int64_t mantissa : mantissas) {
      all.push_back(make(mantissa, exponent));
      all.push_back(make(-mantissa, exponent));
    }
  }
  return all;
}

const std::vector<int> kMiddle{-60, -40, -32, -31, -30, -29, -28, -27, -2, -1, 0, 1, 2, 3, 17, 30, 31, 32, 33};

/// |mantissa 2^exponent - a.mantissa b.mantissa 2^(a.exponent + b.exponent)| <= limit units of the result, exactly.
void expect_product(Fixed a, Fixed b) {
  const Fixed result = a * b;
  ASSERT_TRUE(proper(result));
  const Wide exact = static_cast<Wide>(a.mantissa()) * b.mantissa();
  if (exact == 0) {
    ASSERT_EQ(result.mantissa(), 0);
    return;
  }
  const int shift = result.exponent() - a.exponent() - b.exponent();  // 28 or 29
  const Wide off = (static_cast<Wide>(result.mantissa()) << shift) - exact;
  const Wide half = static_cast<Wide>(1) << (shift - 1);
  ASSERT_LE(off < 0 ? -off : off, half) << real(a) << " * " << real(b);
}

TEST(Fixed, ProductsAreRoundedToTheNearest) {
  const std::vector<Fixed> all = operands(kMiddle, 10, test::seed(70));
  for (const Fixed a : all) {
    for (const Fixed b : all) expect_product(a, b);
  }
}

TEST(Fixed, QuotientsAreWithinThreeQuarterUnits) {
  const std::vector<Fixed> all = operands({-3, 0, 1, 30}, 60, test::seed(71));
  Fixed::clear_overflow_count();
  double worst = 0;
  for (const Fixed a : all) {
    for (const Fixed b : all) {
      if (b.mantissa() == 0) continue;
      const Fixed q = a / b;
      ASSERT_TRUE(proper(q));
      if (a.mantissa() == 0) {
        ASSERT_EQ(q.mantissa(), 0);
        continue;
      }
      // |q b - a| over |b| in units of q: integers of 128 bits, at the smaller of the two exponents.
      const int qb = q.exponent() + b.exponent();
      const int low = std::min(qb, static_cast<int>(a.exponent()));
      const Wide off = ((static_cast<Wide>(q.mantissa()) * b.mantissa()) << (qb - low)) -
                       (static_cast<Wide>(a.mantissa()) << (a.exponent() - low));
      const Wide one = static_cast<Wide>(b.mantissa()) << (qb - low);
      worst = std::max(worst, std::abs(static_cast<double>(off) / static_cast<double>(one)));
      ASSERT_TRUE(a != b || q == Fixed(1));
    }
  }
  EXPECT_LE(worst, 0.76);
  EXPECT_GE(worst, 0.45);  // rounding to the nearest gets close to one half somewhere
  EXPECT_EQ(Fixed::overflow_count(), 0U);
}

TEST(Fixed, SumsAndDifferencesAreWithinOneUnitOfTheLargest) {
  const std::vector<Fixed> all = operands(kMiddle, 6, test::seed(72));
  for (const Fixed a : all) {
    for (const Fixed b : all) {
      for (const bool minus : {false, true}) {
        const Fixed s = minus ? a - b : a + b;
        ASSERT_TRUE(proper(s));
        const int low = std::min({a.mantissa() == 0 ? 99 : a.exponent(), b.mantissa() == 0 ? 99 : b.exponent(),
                                  s.mantissa() == 0 ? 99 : s.exponent()});
        if (low == 99) continue;
        const auto at_low = [low](Fixed x) {
          return x.mantissa() == 0 ? Wide{0} : static_cast<Wide>(x.mantissa()) << (x.exponent() - low);
        };
        const Wide off = at_low(s) - at_low(a) - (minus ? -at_low(b) : at_low(b));
        const double largest = std::max({std::abs(real(a)), std::abs(real(b)), std::abs(real(s))});
        ASSERT_LE(std::ldexp(std::abs(static_cast<double>(off)), low), unit(largest)) << real(a) << ' ' << real(b);
      }
    }
  }
}

TEST(Fixed, RootsAreWithinOneUnit) {
  double worst = 0;
  std::mt19937_64 random(test::seed(73));
  for (int i = 0; i < 200'000; ++i) {
    std::int64_t mantissa = Fixed::kLeastMantissa + static_cast<std::int64_t>(random() % Fixed::kLeastMantissa);
    if (i < 100) mantissa = Fixed::kLeastMantissa + i;
    if (i >= 100 && i < 200) mantissa = Fixed::kMostMantissa - (i - 100);
    const Fixed x = make(mantissa, kLeast + static_cast<int>(random() % (kMost - kLeast + 1)));
    const Fixed root = square_root(x);
    ASSERT_TRUE(proper(root));
    // (root + d)^2 = x gives d = (x - root^2) / (2 root) to first order; root^2 has 58 bits and x none beyond.
    const int shift = 2 * root.exponent() - x.exponent();
    const Wide square = static_cast<Wide>(root.mantissa()) * root.mantissa();
    const Wide off = (static_cast<Wide>(x.mantissa()) << -shift) - square;
    worst = std::max(worst, std::abs(static_cast<double>(off)) / (2.0 * root.mantissa()));
  }
  EXPECT_LE(worst, 1.0);
  EXPECT_GE(worst, 0.45);
  EXPECT_EQ(square_root(Fixed()), Fixed());
  EXPECT_EQ(square_root(Fixed(-4)), Fixed());
  EXPECT_EQ(square_root(Fixed(144)), Fixed(12));
}

TEST(Fixed, ComparesAsTheRealNumbersDo) {
  std::vector<int> exponents = kMiddle;
  exponents.push_back(kLeast);
  exponents.push_back(kMost);
  const std::vector<Fixed> all = operands(exponents, 4, test::seed(74));
  for (const Fixed a : all) {
    for (const Fixed b : all) {
      ASSERT_EQ(a < b, real(a) < real(b));
      ASSERT_EQ(a <= b, real(a) <= real(b));
      ASSERT_EQ(a > b, real(a) > real(b));
      ASSERT_EQ(a >= b, real(a) >= real(b));
      ASSERT_EQ(a == b, real(a) == real(b));
      ASSERT_EQ(a != b, real(a) != real(b));
    }
  }
  // Two ways to write the same number: 2^29 2^0 and 2^28 2^1.
  EXPECT_EQ(make(Fixed::kMostMantissa, 0), make(Fixed::kLeastMantissa, 1));
}

TEST(Fixed, WhatDoesNotFitIsHeldAndCounted) {
  const Fixed top = Fixed::largest();
  const Fixed bottom = -top;
  struct Case {
    std::function<Fixed()> operation;
    Fixed expected;
  };
  const Case cases[] = {
      {[=] { return top + top; }, top},
      {[=] { return bottom - top; }, bottom},
      {[=] { return top * Fixed(2); }, top},
      {[=] { return top * Fixed(-2); }, bottom},
      {[=] { return top * top; }, top},
      {[=] { return bottom * top; }, bottom},
      {[=] { return bottom * bottom; }, top},
      {[=] { return top / make(1, -20); }, top},
      {[=] { return top / Fixed(0); }, top},
      {[=] { return bottom / Fixed(0); }, bottom},
      {[] { return Fixed(0) / Fixed(0); }, Fixed(0)},
      {[] { return make(1, 300); }, top},
      {[] { return make(-1, 300); }, bottom},
  };
  for (const Case& c : cases) {
    Fixed::clear_overflow_count();
    EXPECT_EQ(c.operation(), c.expected);
    EXPECT_EQ(Fixed::overflow_count(), 1U) << &c - cases;
  }
  // What fits is not counted, and what is too small is zero.
  Fixed::clear_overflow_count();
  EXPECT_EQ(top - top, Fixed(0));
  EXPECT_EQ(top * Fixed(1), top);
  EXPECT_EQ(top / Fixed(1), top);
  const Fixed least = make(Fixed::kLeastMantissa, kLeast);
  EXPECT_EQ(least * Fixed(1), least);
  EXPECT_EQ(least * make(1, -1), Fixed(0));
  EXPECT_EQ(least * least, Fixed(0));
  EXPECT_EQ(least / top, Fixed(0));
  EXPECT_EQ(make(Fixed::kLeastMantissa + 1, kLeast) - least, Fixed(0));
  EXPECT_EQ(Fixed(0) * top, Fixed(0));
  EXPECT_EQ(Fixed(0) * Fixed(0), Fixed(0));
  EXPECT_EQ(Fixed(0) + least, least);
  EXPECT_EQ(Fixed::overflow_count(), 0U);
}

TEST(Fixed, IntegersInAndOut) {
  Fixed::clear_overflow_count();
  std::mt19937_64 random(test::seed(75));
  for (int i = 0; i < 100'000; ++i) {
    const auto any = static_cast<std::int32_t>(random());
    const std::int32_t small = any >> 2;  // within 29 bits and the sign: exact
    ASSERT_EQ(static_cast<std::int32_t>(Fixed(small)), small);
    ASSERT_LE(std::abs(real(Fixed(any)) - any), unit(any) / 2);
    // Parts are cut towards zero, as a cast of a double does.
    const int down = static_cast<int>(random() % 40);
    const Fixed part = Fixed(small) * make(1, -down);
    ASSERT_EQ(static_cast<std::int32_t>(part), static_cast<std::int32_t>(real(part)));
  }
  for (const std::int32_t edge : {0, 1, -1, 1 << 29, -(1 << 29), (1 << 29) - 1}) {
    EXPECT_EQ(static_cast<std::int32_t>(Fixed(edge)), edge);
  }
  EXPECT_EQ(static_cast<std::int32_t>(Fixed(INT32_MIN)), INT32_MIN);
  EXPECT_EQ(Fixed::overflow_count(), 0U);
  EXPECT_EQ(static_cast<std::int32_t>(make(1, 31)), INT32_MAX);
  EXPECT_EQ(static_cast<std::int32_t>(make(-3, 31)), INT32_MIN);
  EXPECT_EQ(static_cast<std::int32_t>(Fixed::largest()), INT32_MAX);
  EXPECT_EQ(Fixed::overflow_count(), 3U);
}

TEST(Fixed, MantissasOfAnySizeAreRoundedOnce) {
  std::mt19937_64 random(test::seed(77));
  for (int i = 0; i < 20'000; ++i) {
    auto any = static_cast<std::int64_t>(random());
    if (i == 0) any = INT64_MIN;
    if (i == 1) any = INT64_MAX;
    const std::int64_t wide = any >> static_cast<int>(random() % 40);
    const Fixed x = make(wide, 0);
    ASSERT_TRUE(proper(x));
    const Wide off = (static_cast<Wide>(x.mantissa()) << (x.exponent() < 0 ? 0 : x.exponent())) -
                     (static_cast<Wide>(wide) << (x.exponent() < 0 ? -x.exponent() : 0));
    ASSERT_LE(2 * (off < 0 ? -off : off), Wide{1} << (x.exponent() < 0 ? 0 : x.exponent())) << wide;
  }
}

TEST(Fixed, IntegersAtTheVeryEnds) {
  // Rounded to 29 bits the largest integer is 2^31, which is none; the least is itself.
  Fixed::clear_overflow_count();
  EXPECT_EQ(static_cast<std::int32_t>(Fixed(INT32_MAX)), INT32_MAX);
  EXPECT_EQ(Fixed::overflow_count(), 1U);
  EXPECT_EQ(static_cast<std::int32_t>(make(-Fixed::kMostMantissa, 3)), INT32_MIN);
  EXPECT_EQ(Fixed::overflow_count(), 2U);
  EXPECT_EQ(static_cast<std::int32_t>(make((1LL << 31) - 4, 0)), INT32_MAX - 3);
  EXPECT_EQ(Fixed::overflow_count(), 2U);
}

TEST(Fixed, CompoundOperatorsAreTheSimpleOnes) {
  const Fixed a = make(300'000'001, -7);
  const Fixed b = make(-412'345'679, -9);
  Fixed x = a;
  EXPECT_EQ(x += b, a + b);
  EXPECT_EQ(x -= a, a + b - a);
  EXPECT_EQ(x *= a, (a + b - a) * a);
  EXPECT_EQ(x /= b, (a + b - a) * a / b);
  EXPECT_EQ(+x, x);
  using Limits = std::numeric_limits<Fixed>;
  EXPECT_EQ(Limits::max(), Fixed::largest());
  EXPECT_EQ(Limits::lowest(), -Fixed::largest());
  EXPECT_EQ(real(Limits::min()), std::ldexp(1.0, -128));
  EXPECT_EQ(real(Limits::epsilon()), std::ldexp(1.0, -28));
}

TEST(Fixed, ConstantsAreTheNearest) {
  constexpr auto kTenth = Fixed(0.1);
  EXPECT_LE(std::abs(real(kTenth) - 0.1), unit(0.1) / 2);
  EXPECT_EQ(real(Fixed(1e-6)), real(make(281474977, -48)));  // 1e-6 2^48 = 281474976.71
  EXPECT_EQ(Fixed(1.0), Fixed(1));
  EXPECT_EQ(Fixed(-0.5), make(-1, -1));
  EXPECT_EQ(Fixed(0.0), Fixed(0));
  EXPECT_EQ(real(Fixed(1e12)), std::ldexp(std::round(std::ldexp(1e12, -11)), 11));
}

// Laws that hold to the bit, whatever the operands.
TEST(Fixed, Laws) {
  test::check_property(76, 20'000, [](std::int32_t a, std::int32_t b, std::int8_t p, std::int8_t q) {
    const Fixed x = make(a, p / 2);
    const Fixed y = make(b, q / 2);
    RC_ASSERT(proper(x) && proper(x * y) && proper(x + y) && proper(x - y));
    RC_ASSERT(x * y == y * x);
    RC_ASSERT(x + y == y + x);
    RC_ASSERT(x - y == x + -y);
    RC_ASSERT(x - x == Fixed(0));
    RC_ASSERT(x * Fixed(1) == x);
    RC_ASSERT(x + Fixed(0) == x);
    RC_ASSERT(x * make(1, 5) / make(1, 5) == x);
    RC_ASSERT((x < y) == (Fixed(0) < y - x) || x - y == Fixed(0));
  });
}

}  // namespace
}  // namespace steerid
