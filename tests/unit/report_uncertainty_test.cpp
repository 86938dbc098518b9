// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "report/uncertainty.hpp"

namespace steerid::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// The first is the GUM's own example of a result (JCGM 100:2008, 7.2.2): 100.02147 g with 0.35 mg.
TEST(Uncertainty, TwoDigitsOfTheDeviationSetTheDecimals) {
  EXPECT_EQ(with_sd(100.02147, 0.00035), "100.02147 \u00b1 0.00035");
  EXPECT_EQ(with_sd(0.110287, 0.0012345), "0.1103 \u00b1 0.0012");
  EXPECT_EQ(with_sd(22.70123, 0.0911), "22.701 \u00b1 0.091");
  EXPECT_EQ(with_sd(-3.1648, 0.25), "\u22123.16 \u00b1 0.25");
  EXPECT_EQ(with_sd(95.1089, 14.2), "95 \u00b1 14");
  EXPECT_EQ(with_sd(12345, 678), "12350 \u00b1 680");
}

TEST(Uncertainty, RoundingUpDoesNotAddADigit) {
  EXPECT_EQ(with_sd(1.23456, 0.00996), "1.235 \u00b1 0.010");
  EXPECT_EQ(in_digits(0.99996), "1.000");
  EXPECT_EQ(in_digits(9.996, 3), "10.0");
}

TEST(Uncertainty, WithoutADeviationFourDigits) {
  for (const double sd : {0.0, -1.0, kNan, kInf}) EXPECT_EQ(with_sd(22.70123, sd), "22.70");
  EXPECT_EQ(in_digits(0), "0");
  EXPECT_EQ(in_digits(-0.00123456), "\u22120.001235");
  EXPECT_EQ(in_digits(kNan), "\u2013");
  EXPECT_EQ(with_sd(kInf, 1), "\u2013");
  EXPECT_EQ(written(kNan, 1).sd, "");
}

TEST(Uncertainty, TheEndsOfAnIntervalStayApart) {
  EXPECT_EQ(in_interval(1.5, 2.25), "1.50 to 2.25");
  EXPECT_EQ(in_interval(3.7001, 3.7042), "3.700 to 3.704");
  EXPECT_EQ(in_interval(3.7, 3.7), "3.70");
  EXPECT_EQ(in_interval(-0.00012, 0.00034, 2), "\u22120.00012 to 0.00034");
}

TEST(Uncertainty, AValueAndItsIntervalShareTheDecimalsThatTheIntervalBears) {
  EXPECT_EQ(with_interval(0.29973, {0.24271, 0.36009}), "0.30 (0.24 to 0.36)");
  EXPECT_EQ(with_interval(-0.0004, {-0.0012, 0.0003}), "\u22120.0004 (\u22120.0012 to 0.0003)");
  EXPECT_EQ(with_interval(3.7, {3.7, 3.7}), "3.70");
  EXPECT_EQ(with_interval(kNan, {0, 1}), "\u2013");
}

TEST(Uncertainty, EdgesOfBinsStayApart) {
  const auto decimals = [](std::vector<double> edges) { return decimals_apart(edges); };
  EXPECT_EQ(decimals({0, 0.15, 0.35, 0.75, 1.5, 3}), 2);
  EXPECT_EQ(decimals({0.1881, 0.1912, 0.1912, 0.1987, 0.2049}), 3);
  EXPECT_EQ(decimals({-20, 0, 20}), 0);
  EXPECT_EQ(decimals({5}), 0);
  EXPECT_EQ(in_decimals(-0.0004, 2), "0.00");
  EXPECT_EQ(in_decimals(-1.26, 1), "\u22121.3");
  EXPECT_EQ(in_decimals(kInf, 1), "\u2013");
}

}  // namespace
}  // namespace steerid::report
