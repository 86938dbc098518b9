// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Differentiator, second-order filter and common filter against closed forms in the frequency domain.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "identifier/common_filter.hpp"
#include "identifier/differentiator.hpp"
#include "identifier/second_order_filter.hpp"

namespace steerid {
namespace {

using Complex = std::complex<double>;
constexpr double kPeriod = 0.01;
constexpr double kTurn = 2 * std::numbers::pi;

class DifferentiatorAt : public ::testing::TestWithParam<double> {};

// The header's figures: the rate is too small by (wT)^4/30 and the acceleration by (wT)^4/90. The next terms of the
// two series are (wT)^6/252 and (wT)^6/1008 (Taylor), hence the allowance relative to the figure.
TEST_P(DifferentiatorAt, HasTheErrorThatItsHeaderStates) {
  const double w = kTurn * GetParam();
  const double wt = w * kPeriod;
  Differentiator<double> differentiator;
  double rate_against = 0;
  double acceleration_against = 0;
  const int period = static_cast<int>(std::lround(1 / (GetParam() * kPeriod)));
  for (int k = 0; k < 5; ++k) differentiator.push(std::sin(w * kPeriod * k));
  for (int k = 5; k < 5 + period; ++k) {
    differentiator.push(std::sin(w * kPeriod * k));
    const double at = w * kPeriod * (k - Differentiator<double>::kDelay);
    const Vector3<double> d = differentiator.derivatives(1 / kPeriod);
    ASSERT_NEAR(d(2), std::sin(at), 1e-12);
    rate_against += 2.0 / period * d(1) / w * std::cos(at);
    acceleration_against += -2.0 / period * d(0) / (w * w) * std::sin(at);
  }
  EXPECT_NEAR((1 - rate_against) / (std::pow(wt, 4) / 30), 1.0, 0.2 * wt * wt + 1e-4);
  EXPECT_NEAR((1 - acceleration_against) / (std::pow(wt, 4) / 90), 1.0, 0.2 * wt * wt + 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Hertz, DifferentiatorAt, ::testing::Values(1.0, 2.0, 5.0, 10.0));

TEST(Differentiator, IsExactOnAPolynomialOfOrderFour) {
  Differentiator<double> differentiator;
  const auto f = [](double t) { return 3 - 2 * t + t * t - 4 * t * t * t + 5 * t * t * t * t; };
  for (int k = -2; k <= 2; ++k) differentiator.push(f(0.5 + 0.1 * k));
  const Vector3<double> d = differentiator.derivatives(10);
  EXPECT_NEAR(d(1), -2 + 2 * 0.5 - 12 * 0.25 + 20 * 0.125, 1e-12);
  EXPECT_NEAR(d(0), 2 - 24 * 0.5 + 60 * 0.25, 1e-11);
}

TEST(Differentiator, HasNoRateAfterAFill) {
  Differentiator<float> differentiator;
  differentiator.push(3.0F);
  differentiator.fill(1.25F);
  const Vector3<float> d = differentiator.derivatives(100.0F);
  EXPECT_EQ(d, Vector3<float>(0.0F, 0.0F, 1.25F));
}

// In float an angle of 0.3 rad stands on steps of 3e-8 rad and moves by 0.019 rad a sample at most, known to 1e-9. The
// acceleration makes (15 sqrt(2) / 12) 1e4 of the step's rounding and sqrt(16^2 + 16^2 + 30^2 + 2) / 12 1e4 of the
// place's: 1e-5 and 3e-4 rad/s2 rms. The limits are six times and twice that.
TEST(Differentiator, LosesNothingToWhereTheSignalStandsWhenItIsToldTheSteps) {
  const auto angle = [](int k) { return 0.3 * std::sin(kTurn * kPeriod * k); };
  Differentiator<double> exact;
  Differentiator<float> told;
  Differentiator<float> untold;
  double told_off = 0;
  double untold_off = 0;
  for (int k = 0; k < 1000; ++k) {
    exact.push(angle(k));
    told.push({static_cast<float>(angle(k)), static_cast<float>(angle(k) - angle(k - 1))});
    untold.push(static_cast<float>(angle(k)));
    if (k < Differentiator<float>::kLength) continue;
    const double acceleration = exact.derivatives(100)(0);
    told_off = std::max(told_off, std::abs(static_cast<double>(told.derivatives(100)(0)) - acceleration));
    untold_off = std::max(untold_off, std::abs(static_cast<double>(untold.derivatives(100)(0)) - acceleration));
  }
  EXPECT_LT(told_off, 6e-5);
  EXPECT_GT(untold_off, 6e-4);
}

/// Response at w, from the last whole second after the transient has gone.
Complex measured_response(const SecondOrderCoefficients<double>& c, double w, double period_s) {
  SecondOrderFilter<double> filter;
  const int settle = static_cast<int>(std::lround(20 / period_s));
  const int window = static_cast<int>(std::lround(1 / period_s));
  Complex sum = 0;
  for (int k = 0; k < settle + window; ++k) {
    const double out = filter.step(std::sin(w * period_s * k), c, period_s);
    if (k >= settle) sum += out * std::polar(1.0, -w * period_s * k) * 2.0 / static_cast<double>(window);
  }
  return sum * Complex(0, 1);
}

// v_n = keep v_{n-1} + step (u_n - y_{n-1}), y_n = y_{n-1} + T v_n, z-transformed by hand.
Complex discrete_response(double w2, double d2, double w, double period_s) {
  const double keep = 1 / (1 + period_s * d2);
  const Complex z = std::polar(1.0, w * period_s);
  return period_s * period_s * w2 * keep / ((1.0 - 1.0 / z) * (1.0 - keep / z) + period_s * period_s * w2 * keep / z);
}

Complex continuous_response(double w2, double d2, double w) { return w2 / Complex(w2 - w * w, d2 * w); }

TEST(SecondOrderFilter, HasTheResponseOfItsDifferenceEquation) {
  for (const double hz : {1.0, 4.0, 10.0, 25.0}) {
    const Complex measured = measured_response(second_order_coefficients(450.0, 25.0, kPeriod), kTurn * hz, kPeriod);
    EXPECT_LT(std::abs(measured - discrete_response(450.0, 25.0, kTurn * hz, kPeriod)), 1e-9) << hz << " Hz";
  }
}

TEST(SecondOrderFilter, TendsToTheContinuousOneWithTheFirstPowerOfThePeriod) {
  const double w = kTurn * 2;
  const auto error = [w](double period_s) {
    return std::abs(measured_response(second_order_coefficients(450.0, 25.0, period_s), w, period_s) -
                    continuous_response(450.0, 25.0, w));
  };
  EXPECT_NEAR(error(0.002) / error(0.001), 2.0, 0.1);
  EXPECT_LT(error(0.001), 0.02);
}

TEST(SecondOrderFilter, StaysWhereItSettles) {
  SecondOrderFilter<float> filter;
  filter.settle_at(-2.5F);
  const auto c = second_order_coefficients(450.0F, 25.0F, 0.01F);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(filter.step(-2.5F, c, 0.01F), -2.5F);
}

/// w2 and d2 of a filter, back from its coefficients.
struct Continuous {
  double w2;
  double d2;
  explicit Continuous(const SecondOrderCoefficients<double>& c)
      : w2(c.stiffness_step / (kPeriod * c.rate_keep)), d2((1 / c.rate_keep - 1) / kPeriod) {}
};

// s_u^2 + s_th^2 |J s^2 + B s + C|^2 = s_th^2 J^2 |s^2 + d2 s + w2|^2: behind F the equation's error is white.
TEST(SecondOrderFilter, TellsTheStepThatItTook) {
  SecondOrderFilter<double> filter;
  const auto coefficients = second_order_coefficients(300.0, 20.0, kPeriod);
  double before = 0;
  for (int k = 0; k < 200; ++k) {
    const Moved<double> moved = filter.move(std::sin(0.3 * k), coefficients, kPeriod);
    ASSERT_NEAR(moved.by, moved.to - before, 1e-15);
    before = moved.to;
  }
}

TEST(CommonFilter, IsKnownByItsCoefficients) {
  const CommonFilter<double> filter{437, 31};
  const CommonFilter<double> again = CommonFilter<double>::of(filter.at(kPeriod), kPeriod);
  EXPECT_NEAR(again.corner / filter.corner, 1, 1e-14);
  EXPECT_NEAR(again.rate / filter.rate, 1, 1e-14);
}

TEST(CommonFilter, IsTheSpectralFactorOfTheEquationError) {
  const Vector3<double> arms[] = {{0.11, 1.5, 22.7}, {0.06, 0.4, 12.0}, {0.11, 2.1, 45.9}, {0.11, 2.9, 10.2}};
  for (const Vector3<double>& p : arms) {
    for (const double rho_squared : {900.0, 1800.0, 10000.0}) {
      const Continuous f(common_filter(p, rho_squared).at(kPeriod));
      for (double hz = 0; hz < 50; hz += 0.37) {
        const Complex s(0, kTurn * hz);
        const double error = rho_squared + std::norm(p(0) * s * s + p(1) * s + p(2));
        const double factor = p(0) * p(0) * std::norm(s * s + f.d2 * s + f.w2);
        ASSERT_NEAR(factor / error, 1.0, 1e-12) << hz << " Hz, rho^2 " << rho_squared;
      }
    }
  }
}

// A step's response is off its end by less than a thousandth from ring_out() on (critical damping: by (1 + x) e^-x,
// eight times that), and by more than a hundredth at a quarter of it.
TEST(CommonFilter, KnowsWhenItHasRungOut) {
  for (const CommonFilter<double> filter : {CommonFilter<double>{300, 20}, {100, 27}, {400, 20}, {100, 20}}) {
    const int end = filter.ring_out(kPeriod);
    SecondOrderFilter<double> step;
    double early = 0;
    double late = 0;
    for (int k = 0; k < 3 * end; ++k) {
      const double off = std::abs(step.step(1.0, filter.at(kPeriod), kPeriod) - 1.0);
      if (k >= end / 4 && k < end / 2) early = std::max(early, off);
      if (k >= end) late = std::max(late, off);
    }
    EXPECT_LT(late, 0.008);
    EXPECT_GT(early, 0.01);
  }
}

TEST(CommonFilter, HoldsItsCornerBetweenOnePointSixAndElevenHertz) {
  const Continuous slow(common_filter(Vector3<double>(0.6, 1.0, 0.01), 0.0).at(kPeriod));
  EXPECT_NEAR(slow.w2, 100.0, 1e-9);
  const Continuous fast(common_filter(Vector3<double>(0.005, 0.01, 300.0), 1e9).at(kPeriod));
  EXPECT_NEAR(fast.w2, 4900.0, 1e-7);
  // Neither rings: its damping ratio d2 / (2 sqrt(w2)) is at least one half.
  EXPECT_GE(slow.d2, std::sqrt(slow.w2) * (1 - 1e-12));
  EXPECT_GE(fast.d2, std::sqrt(fast.w2) * (1 - 1e-12));
}

}  // namespace
}  // namespace steerid
