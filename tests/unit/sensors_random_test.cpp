// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sensors/normal_table.hpp"
#include "sensors/random.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

// Limits of the statistical tests: 4.5 standard deviations of the statistic, passed by chance once in 150,000 runs.
constexpr double kSigmas = 4.5;

TEST(Random, GivesThePublishedSequence) {
  // The demonstration of PCG's reference implementation (pcg32-demo, seed 42, stream 54) prints these first.
  Random random(42, 54);
  for (const std::uint32_t expected : {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU}) {
    EXPECT_EQ(random.bits(), expected);
  }
}

TEST(Random, InvertsTheNormalDistribution) {
  // P(Z < z) = erfc(-z/sqrt 2)/2. AS 241 promises a relative accuracy of 1e-16 in z; a relative error e of z shows as
  // |z| phi(z)/P e < (1 + z^2) e in P, and erfc adds a few roundings of its own.
  for (const double p : {1e-15, 1e-9, 1e-6, 1e-3, 0.01, 0.0749, 0.0751, 0.3, 0.49999, 0.5, 0.7, 0.9251, 0.99, 0.9999}) {
    const double z = normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-z / std::sqrt(2.0)) / p, 1.0, 4e-16 * (1.0 + z * z)) << p;
  }
}

/// P(Z < z) less p as an error of z in standard deviations; p in the lower half, where erfc is accurate.
double error_of_z(double z, double p) {
  const double density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
  return (0.5 * std::erfc(-z / std::numbers::sqrt2) - p) / density;
}

TEST(NormalTable, InvertsTheNormalDistributionOutToItsEnds) {
  // Promised: 1e-8. Each leading zero of the magnitude is an octave of the probability; seeds within an octave.
  Random random(test::seed(4));
  double worst = 0;
  for (unsigned octave = 0; octave < 53; ++octave) {
    for (int i = 0; i < 2000; ++i) {
      const std::uint64_t high = random.bits();
      const std::uint64_t magnitude = ((high << 32U) | random.bits()) >> (1 + octave);
      const double p = (2.0 * static_cast<double>(magnitude >> 11U) + 1.0) * 0x1p-54;
      const double z = NormalTable::shared().quantile(magnitude);
      worst = std::max(worst, std::abs(error_of_z(z, p)));
      // The first bit is the sign and nothing else.
      ASSERT_EQ(NormalTable::shared().quantile(magnitude | (std::uint64_t{1} << 63U)), -z);
    }
  }
  EXPECT_LT(worst, 1e-8);
  EXPECT_GT(worst, 1e-12) << "so good an answer is not the table's";
}

TEST(NormalTable, NeverFallsWhereItsSegmentsMeet) {
  // Neighbouring magnitudes around every edge between two segments: 32 an octave, p = odd 2^-54.
  for (int exponent = 6; exponent < 53; ++exponent) {
    for (std::uint64_t segment = 32; segment < 64; ++segment) {
      const std::uint64_t edge = segment << static_cast<unsigned>(exponent - 5);  // the value of 2 k + 1 that it is
      const auto at = [](std::uint64_t odd) { return NormalTable::shared().quantile(odd << 10U); };
      ASSERT_LE(at(edge - 1), at(edge + 1)) << exponent << ' ' << segment;
      ASSERT_NEAR(at(edge - 1), normal_quantile(static_cast<double>(edge - 1) * 0x1p-54), 1e-8);
      ASSERT_NEAR(at(edge + 1), normal_quantile(static_cast<double>(edge + 1) * 0x1p-54), 1e-8);
    }
  }
}

TEST(Random, IsUniform) {
  Random random(test::seed(1));
  constexpr int kDraws = 1'000'000;
  constexpr int kBins = 100;
  std::array<int, kBins> count{};
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++count[static_cast<std::size_t>(u * kBins)];
  }
  constexpr double kExpected = static_cast<double>(kDraws) / kBins;
  double chi_squared = 0;
  for (const int n : count) chi_squared += (n - kExpected) * (n - kExpected) / kExpected;
  // Chi-squared with 99 degrees of freedom: mean 99, standard deviation sqrt(198); too even is as wrong as too uneven.
  EXPECT_NEAR(chi_squared, kBins - 1, kSigmas * std::sqrt(2.0 * (kBins - 1)));
}

TEST(Random, IsNormal) {
  Random random(test::seed(2));
  constexpr int kDraws = 1'000'000;
  double m1 = 0;
  double m2 = 0;
  double m3 = 0;
  double m4 = 0;
  double neighbours = 0;
  double last = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    m1 += z;
    m2 += z * z;
    m3 += z * z * z;
    m4 += z * z * z * z;
    neighbours += z * last;
    last = z;
  }
  // Variances of z, z^2, z^3, z^4 and of the product of two: 1, 2, 15, 96 and 1.
  const double limit = kSigmas / std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(m1 / kDraws, 0.0, limit);
  EXPECT_NEAR(m2 / kDraws, 1.0, limit * std::sqrt(2.0));
  EXPECT_NEAR(m3 / kDraws, 0.0, limit * std::sqrt(15.0));
  EXPECT_NEAR(m4 / kDraws, 3.0, limit * std::sqrt(96.0));
  EXPECT_NEAR(neighbours / kDraws, 0.0, limit);
}

TEST(Random, StreamsAreIndependentAndSeedsRepeat) {
  const std::uint64_t seed = test::seed(3);
  Random a(seed, 0);
  Random again(seed, 0);
  Random b(seed, 1);
  Random c(seed + 1, 0);
  constexpr int kDraws = 100'000;
  double with_b = 0;
  double with_c = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = a.normal();
    ASSERT_EQ(x, again.normal());
    with_b += x * b.normal();
    with_c += x * c.normal();
  }
  const double limit = kSigmas / std::sqrt(static_cast<double>(kDraws));
  EXPECT_NEAR(with_b / kDraws, 0.0, limit);
  EXPECT_NEAR(with_c / kDraws, 0.0, limit);
}

}  // namespace
}  // namespace steerid
