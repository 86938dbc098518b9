// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whitening filter that makes slow noise white, and its inverse, against its answer to an impulse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "identifier/noise_colour.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// In discrete time it is (1 - depth)^2 times the square root of the whitening filter's gain at high frequencies,
// whatever the depth: white noise and slow noise come out alike.
TEST(WhiteningFilter, LeavesTheSquareOfOneMinusDepthAtRest) {
  for (const double depth : {0.0, 0.5, 0.75, 0.9}) {
    const auto shape = WhiteningShape<double>::of_depth(depth);
    WhiteningFilter<double> whitening;
    WhiteningFilter<double> settled;
    settled.settle_at(3.0);
    double y = 0;
    for (int k = 0; k < 5000; ++k) y = whitening.step(3.0, shape);
    EXPECT_NEAR(y, 3.0 * (1 - depth) * (1 - depth) * std::sqrt(shape.direct()), 1e-9);
    EXPECT_NEAR(y, 3.0 * shape.at_rest(), 1e-12);
    EXPECT_NEAR(settled.step(3.0, shape), y, 1e-12);
  }
}

/// |D|^2 of the discrete filter itself at f_hz, from its answer to an impulse.
double power_through(const WhiteningShape<double>& shape, double f_hz) {
  WhiteningFilter<double> whitening;
  std::complex<double> sum;
  for (int k = 0; k < 8000; ++k)
    sum += whitening.step(k == 0 ? 1.0 : 0.0, shape) * std::polar(1.0, -kTurn * f_hz * 0.01 * k);
  return std::norm(sum);
}

// White noise of variance 1 and two lags at 0.3 Hz on white noise, R times as dense at rest: behind the whitening
// filter of depth 1 - (1 + R)^-1/4 the spectrum is flat. The lags' spectrum is R ((1 - q)^2 / |1 - q/z|^2)^2.
TEST(WhiteningFilter, MakesSlowNoiseAndWhiteNoiseWhite) {
  const double q = std::exp(-kTurn * 0.3 * 0.01);
  for (const double depth : {0.2, 0.5, 0.75, 0.9, 0.95}) {
    const auto shape = WhiteningShape<double>::of_depth(depth);
    const double density = std::pow(1 - depth, -4) - 1;
    for (const double f_hz : {0.02, 0.1, 0.3, 0.7, 1.5, 3.0, 6.0, 12.0, 25.0, 50.0}) {
      const double lag = (1 - q) * (1 - q) / std::norm(1.0 - q * std::polar(1.0, kTurn * f_hz * 0.01));
      const double white = power_through(shape, f_hz) * (1 + density * lag * lag);
      // The constants are rounded to six digits.
      EXPECT_NEAR(white / shape.direct(), 1.0, 1e-3) << depth << " at " << f_hz;
    }
  }
}

TEST(WhiteningFilter, IsUndone) {
  std::mt19937_64 random(test::seed(12));
  std::normal_distribution<double> normal;
  for (const double depth : {0.0, 0.5, 0.75, 0.9}) {
    const auto shape = WhiteningShape<double>::of_depth(depth);
    WhiteningFilter<double> whitening;
    InverseWhiteningFilter<double> inverse_whitening;
    for (int k = 0; k < 5000; ++k) {
      const double x = normal(random);
      ASSERT_NEAR(inverse_whitening.step(whitening.step(x, shape), shape), x, 1e-9);
    }
  }
}

// The formula in s against the discrete filter: what the bilinear difference of w makes below 6 Hz.
TEST(WhiteningFilter, LeavesThePowerItSays) {
  for (const double depth : {0.0, 0.5, 0.75, 0.94}) {
    const auto shape = WhiteningShape<double>::of_depth(depth);
    for (const double f_hz : {0.1, 0.5, 1.0, 3.0, 5.0}) {
      const double w = kTurn * f_hz;
      EXPECT_NEAR(shape.power_left(w * w, 0.01) / power_through(shape, f_hz), 1.0, 0.04) << depth << " " << f_hz;
    }
  }
}

// Two signals that hang together by one factor go on doing so once a change of depth has rung out: to a thousandth of
// the signal, as ring_out() says.
TEST(WhiteningFilter, HasForgottenAChangeWhenItHasRungOut) {
  const auto before = WhiteningShape<double>::of_depth(0.0);
  const auto after = WhiteningShape<double>::of_depth(0.75);
  WhiteningFilter<double> changed;
  WhiteningFilter<double> always;
  int k = 0;
  const auto signal = [&k] { return std::sin(kTurn * 0.7 * 0.01 * k); };
  for (; k < 1000; ++k) {
    changed.step(signal(), before);
    always.step(signal(), after);
  }
  double worst = 0;
  for (; k < 1500; ++k) {
    const double difference = std::abs(changed.step(signal(), after) - always.step(signal(), after));
    if (k == 1002) {
      EXPECT_GT(difference, 0.05);
    }
    if (k >= 1000 + after.ring_out()) worst = std::max(worst, difference);
  }
  // A thousandth of the signal, or eight, were both poles in one place: (1 + 6.9) e^-6.9.
  EXPECT_LT(worst, 0.008);
}

// What it tells of its step is the difference of two outputs while the whitening filter stays as it is.
TEST(WhiteningFilter, TellsTheStepThatItLeaves) {
  WhiteningFilter<double> whitening;
  const auto shape = WhiteningShape<double>::of_depth(0.8);
  Moved<double> x;
  double before = 0;
  for (int k = 1; k < 300; ++k) {
    const double to = std::sin(0.07 * k) + 0.2 * std::sin(0.9 * k);
    x = {to, to - x.to};
    const Moved<double> left = whitening.step(x, shape);
    ASSERT_NEAR(left.by, left.to - before, 1e-14);
    before = left.to;
  }
}

}  // namespace
}  // namespace steerid
