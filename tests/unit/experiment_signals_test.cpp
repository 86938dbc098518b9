// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The signals that tasks are made of, against Fourier sums, closed-form correlations and their sampling distributions.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "experiment/multisine.hpp"
#include "experiment/smooth_noise.hpp"
#include "experiment/triangle.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 4.5;

template <class Source>
std::vector<SignalPoint> ticks(Source& source, int count) {
  std::vector<SignalPoint> out;
  for (int k = 0; k < count; ++k) out.push_back(source.next());
  return out;
}

/// Amplitude and phase of harmonic `k` of one period: x(t) = |c| cos(2 pi k t/P + arg c).
std::complex<double> harmonic(const std::vector<SignalPoint>& period, int k, double SignalPoint::*part) {
  const auto n = static_cast<double>(period.size());
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < period.size(); ++i) {
    sum += period[i].*part * std::polar(1.0, -2 * kPi * k * static_cast<double>(i) / n);
  }
  return 2.0 / n * sum;
}

TEST(Multisine, HasItsRmsItsBandAndNothingElse) {
  for (const bool random : {false, true}) {
    MultisineSettings settings;
    if (random) settings.random_phases = test::seed(30);
    Multisine multisine(settings);
    const auto period = ticks(multisine, 1000);
    double squares = 0;
    double peak = 0;
    for (const SignalPoint& p : period) {
      squares += p.value * p.value;
      peak = std::max(peak, std::abs(p.value));
    }
    const double rms = std::sqrt(squares / 1000);
    EXPECT_NEAR(rms, 1.5, 1e-12);  // Parseval: exact for whole periods
    if (!random) {
      EXPECT_LT(peak / rms, 2.0);  // Schroeder's phases: 1.7 in the literature, sqrt 2 at least
    }
    EXPECT_GT(peak / rms, std::numbers::sqrt2);
    // 0.2 to 5 Hz in steps of 0.1 Hz: harmonics 2 to 50, all of amplitude 1.5 sqrt(2/49).
    for (int k = 0; k < 500; ++k) {
      const double expected = k >= 2 && k <= 50 ? 1.5 * std::sqrt(2.0 / 49.0) : 0.0;
      ASSERT_NEAR(std::abs(harmonic(period, k, &SignalPoint::value)), expected, 1e-12) << k;
    }
  }
}

TEST(Multisine, RepeatsAfterItsPeriodAndStatesItsSlope) {
  Multisine multisine({.rms_nm = 1.0, .low_hz = 0.25, .high_hz = 8.0, .period_s = 4.0});
  const auto first = ticks(multisine, 400);
  const auto second = ticks(multisine, 400);
  for (std::size_t k = 0; k < first.size(); ++k) ASSERT_EQ(first[k].value, second[k].value);
  for (int k = 1; k <= 32; ++k) {
    const auto value = harmonic(first, k, &SignalPoint::value);
    const auto slope = harmonic(first, k, &SignalPoint::slope);
    ASSERT_LT(std::abs(slope - std::complex<double>(0, 2 * kPi * k / 4.0) * value), 1e-10) << k;
  }
}

TEST(Multisine, BetweenTicksIsTheSumOfItsSines) {
  Multisine multisine({.rms_nm = 1.5, .low_hz = 0.2, .high_hz = 5.0, .period_s = 10.0});
  const auto period = ticks(multisine, 1000);
  // The cubic errs by (w dt)^4/384 of each tone; with equal tones the rms of the errors is at most that of the fastest.
  const double limit = 49 * 1.5 * std::sqrt(2.0 / 49.0) * std::pow(2 * kPi * 5.0 * kTickS, 4) / 384;
  double squares = 0;
  for (std::size_t i = 0; i + 1 < period.size(); ++i) {
    double sum = 0;
    for (int k = 2; k <= 50; ++k) {
      const double order = k - 1;
      const double t = (static_cast<double>(i) + 0.5) * kTickS;
      sum += 1.5 * std::sqrt(2.0 / 49.0) * std::cos(2 * kPi * k / 10.0 * t - kPi * order * (order - 1) / 49.0);
    }
    const double error = between(period[i], period[i + 1], kTickS).at(kTickS / 2) - sum;
    ASSERT_LT(std::abs(error), limit);
    squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / 999), 1.5 * 2.5e-5);
}

TEST(Multisine, SeedsGiveDifferentRealisations) {
  const std::uint64_t seed = test::seed(31);
  Multisine a({.random_phases = seed});
  Multisine same({.random_phases = seed});
  Multisine b({.random_phases = seed + 1});
  double product = 0;
  for (int k = 0; k < 1000; ++k) {
    const double x = a.next().value;
    ASSERT_EQ(x, same.next().value);
    product += x * b.next().value / 1000;
  }
  // 49 tones with independent phases: the correlation has a standard deviation of 1/sqrt(2 * 49).
  EXPECT_LT(std::abs(product) / (1.5 * 1.5), kSigmas / std::sqrt(98.0));
}

TEST(Multisine, RefusesABandWithoutTones) {
  EXPECT_THROW(Multisine({.low_hz = 0.21, .high_hz = 0.29}), std::invalid_argument);
  EXPECT_THROW(Multisine({.low_hz = 0.0}), std::invalid_argument);
  EXPECT_THROW(Multisine({.high_hz = 25.0}), std::invalid_argument);
  EXPECT_THROW(Multisine({.rms_nm = -1.0}), std::invalid_argument);
}

TEST(Triangle, HasTheAmplitudeThePeriodAndTheHarmonicsOfATriangle) {
  Triangle triangle(5.0, 4000);
  const auto period = ticks(triangle, 4000);
  const auto again = ticks(triangle, 10);
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(again[k].value, period[k].value);
  EXPECT_EQ(period[0].value, 0.0);
  double highest = 0;
  double lowest = 0;
  for (const SignalPoint& p : period) {
    highest = std::max(highest, p.value);
    lowest = std::min(lowest, p.value);
  }
  // The rounded corner lies half the rounding's 0.05 s times the slope of 0.5 Nm/s below the peak.
  EXPECT_NEAR(highest, 5.0 - 0.0125, 1e-12);
  EXPECT_NEAR(lowest, -5.0 + 0.0125, 1e-12);
  // A triangle's odd harmonics fall with 1/k^2: 8 A/(pi k)^2; rounding takes at most (pi k 0.05/40)^2/6 of them.
  for (const int k : {1, 3, 5, 7, 21}) {
    const double expected = 8 * 5.0 / (kPi * kPi * k * k);
    EXPECT_NEAR(std::abs(harmonic(period, k, &SignalPoint::value)) / expected, 1.0,
                std::pow(2 * kPi * k * 0.05 / 40, 2) / 6 + 1e-5)
        << k;
    EXPECT_NEAR(std::abs(harmonic(period, 2 * k, &SignalPoint::value)), 0.0, 1e-12);
  }
  EXPECT_NEAR(std::arg(harmonic(period, 1, &SignalPoint::value)), -kPi / 2, 1e-9);  // a sine: starts rising
}

TEST(Triangle, IsSmoothAndTheCubicsAreTheTriangleItself) {
  Triangle triangle(5.0, 4000);
  const auto period = ticks(triangle, 4001);
  for (std::size_t k = 0; k + 1 < period.size(); ++k) {
    const Cubic cubic = between(period[k], period[k + 1], kTickS);
    // Straight lines and parabolas: no cubic term, and no slope beyond 0.5 Nm/s.
    ASSERT_NEAR(cubic.c3, 0.0, 1e-6);
    ASSERT_LE(std::abs(cubic.slope(kTickS / 3)), 0.5 + 1e-9);
  }
}

struct Process {
  double corner_hz;
  double damping_ratio;
};

/// Autocorrelation of the oscillator's answer to white noise.
double correlation(const Process& process, double tau_s) {
  const double w0 = 2 * kPi * process.corner_hz;
  const double zeta = process.damping_ratio;
  if (zeta == 1.0) return (1 + w0 * tau_s) * std::exp(-w0 * tau_s);
  const double wd = w0 * std::sqrt(1 - zeta * zeta);
  return std::exp(-zeta * w0 * tau_s) * (std::cos(wd * tau_s) + zeta * w0 / wd * std::sin(wd * tau_s));
}

/// Correlation of its slope with its value tau later, in units of both standard deviations: minus the derivative of the
/// autocorrelation over w0.
double slope_correlation(const Process& process, double tau_s) {
  const double w0 = 2 * kPi * process.corner_hz;
  const double zeta = process.damping_ratio;
  if (zeta == 1.0) return w0 * tau_s * std::exp(-w0 * tau_s);
  const double wd = w0 * std::sqrt(1 - zeta * zeta);
  return w0 / wd * std::exp(-zeta * w0 * tau_s) * std::sin(wd * tau_s);
}

TEST(SmoothNoise, HasTheCorrelationOfASecondOrderProcess) {
  const std::uint64_t seed = test::seed(32);
  constexpr int kRealisations = 20'000;
  constexpr double kRms = 0.7;
  for (const Process process : {Process{0.3, 1.0}, Process{1.0, 0.5}, Process{9.0, 0.1}}) {
    // Lags of a few ticks, between knots and across them.
    const int lags[] = {0, 1, 3, 7, 20, 50};
    double products[6] = {};
    double slope_products[6] = {};
    double slope_squares = 0;
    for (int r = 0; r < kRealisations; ++r) {
      SmoothNoise noise({kRms, process.corner_hz, process.damping_ratio}, seed, static_cast<std::uint64_t>(r));
      const auto run = ticks(noise, 51);
      for (std::size_t i = 0; i < 6; ++i) {
        const double later = run[static_cast<std::size_t>(lags[i])].value;
        products[i] += run[0].value * later;
        slope_products[i] += run[0].slope * later;
      }
      slope_squares += run[0].slope * run[0].slope;
    }
    const double w0 = 2 * kPi * process.corner_hz;
    for (std::size_t i = 0; i < 6; ++i) {
      const double rho = correlation(process, lags[i] * kTickS);
      // Product of two normals of correlation rho: variance 1 + rho^2. Joining knots by cubics adds 1e-5.
      const double limit = kSigmas * std::sqrt((1 + rho * rho) / kRealisations) + 1e-5;
      EXPECT_NEAR(products[i] / kRealisations / (kRms * kRms), rho, limit) << process.corner_hz << ' ' << lags[i];
      const double slope_rho = slope_correlation(process, lags[i] * kTickS);
      EXPECT_NEAR(slope_products[i] / kRealisations / (kRms * kRms * w0), slope_rho,
                  kSigmas * std::sqrt((1 + slope_rho * slope_rho) / kRealisations) + 1e-5)
          << process.corner_hz << ' ' << lags[i];
    }
    EXPECT_NEAR(slope_squares / kRealisations / (kRms * kRms * w0 * w0), 1.0, kSigmas * std::sqrt(2.0 / kRealisations));
  }
}

TEST(SmoothNoise, OffIsExactlyNothing) {
  SmoothNoise noise({.rms = 0.0}, 1, 0);
  for (int k = 0; k < 10; ++k) {
    const SignalPoint p = noise.next();
    ASSERT_EQ(p.value, 0.0);
    ASSERT_EQ(p.slope, 0.0);
  }
}

}  // namespace
}  // namespace steerid
