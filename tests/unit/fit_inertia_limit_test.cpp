// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Records that do not show the inertia: no number with a tiny deviation, but the largest J that they allow.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "fit/gauss_newton.hpp"
#include "fit/inertia_limit.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr int kTones = 49;  // 0.2 to 5 Hz
constexpr int kSamples = 3'000;
constexpr double kStiffness = 20;
constexpr double kAngleNoise_rad = 0.002;

double frequency_hz(int tone) { return 0.1 * (tone + 2); }

/// The steady state under tones of 1.5 Nm rms together, in closed form.
Record steady(double inertia, double damping, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> phase(0, kTurn);
  const double amplitude = 1.5 * std::sqrt(2.0 / kTones);
  std::vector<double> phases;
  for (int n = 0; n < kTones; ++n) phases.push_back(phase(random));
  Record record;
  for (int k = 0; k < kSamples; ++k) {
    const double t = 0.01 * k;
    double torque = 0, angle = 0;
    for (int n = 0; n < kTones; ++n) {
      const double w = kTurn * frequency_hz(n);
      const std::complex<double> gain = 1.0 / std::complex<double>(kStiffness - inertia * w * w, damping * w);
      const auto at = std::polar(amplitude, w * t + phases[static_cast<std::size_t>(n)]);
      torque += at.real();
      angle += (gain * at).real();
    }
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(torque);
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(angle + kAngleNoise_rad * normal(random));
  }
  return record;
}

/// Cramer-Rao deviation of a J near zero, C unknown as well. B is in quadrature with both.
double inertia_bound() {
  const double amplitude = 1.5 * std::sqrt(2.0 / kTones);
  double jj = 0, jc = 0, cc = 0;
  for (int n = 0; n < kTones; ++n) {
    const double square = std::pow(kTurn * frequency_hz(n), 2);
    const double weight = kSamples * amplitude * amplitude / 2 / std::pow(kStiffness, 4) / std::pow(kAngleNoise_rad, 2);
    jj += weight * square * square;
    jc -= weight * square;
    cc += weight;
  }
  return std::sqrt(cc / (jj * cc - jc * jc));
}

BatchFit fit(const Record& record) {
  FitOptions options;
  options.inertia_limit = true;
  return fit_batch(record, options);
}

// Angle = torque/20 + noise. The limit lies three deviations above an estimate that itself scatters by one, and a limit
// below the bound would be a claim that no record can carry.
TEST(InertiaLimit, AMasslessRecordShowsALimitAndNoInertia) {
  std::mt19937_64 random(test::seed(35));
  for (int i = 0; i < 10; ++i) {
    const BatchFit found = fit(steady(0, 0, random));
    EXPECT_EQ(found.inertia.state, ParameterState::kNotExcited) << found.inertia.value << " +- " << found.inertia.sd;
    EXPECT_NEAR(found.stiffness.value, kStiffness, 0.1);
    ASSERT_TRUE(found.inertia.at_most.has_value());
    EXPECT_GT(*found.inertia.at_most, inertia_bound());
    EXPECT_LT(*found.inertia.at_most, 8 * inertia_bound());
  }
}

// An inertia of two bounds, hardly damped: a number with its deviation or a limit, whatever is said holds it.
TEST(InertiaLimit, HoldsASmallInertia) {
  std::mt19937_64 random(test::seed(36));
  const double inertia = 2 * inertia_bound();
  int limits = 0;
  for (int i = 0; i < 10; ++i) {
    const BatchFit found = fit(steady(inertia, 0.02, random));
    if (found.inertia.state == ParameterState::kValid) {
      EXPECT_NEAR(found.inertia.value, inertia, 4 * found.inertia.sd);
      continue;
    }
    ++limits;
    ASSERT_TRUE(found.inertia.at_most.has_value());
    EXPECT_GE(*found.inertia.at_most, inertia);
    EXPECT_LT(*found.inertia.at_most, 12 * inertia_bound());
  }
  EXPECT_GE(limits, 6);  // a quarter of the value is four bounds away from two: few come so far by chance
}

// Inertias that are there are not taken for lines, with damping or next to none.
TEST(InertiaLimit, LeavesATrueInertiaAlone) {
  std::mt19937_64 random(test::seed(37));
  for (const double inertia : {0.01, 0.03, 0.11}) {
    for (const double damping : {0.02, 0.5}) {
      const BatchFit found = fit(steady(inertia, damping, random));
      EXPECT_EQ(found.inertia.state, ParameterState::kValid) << inertia << " " << damping;
      EXPECT_NEAR(found.inertia.value, inertia, 5 * found.inertia.sd + 1e-3 * inertia);
      EXPECT_FALSE(found.inertia.at_most.has_value());
    }
  }
}

TEST(InertiaLimit, IsWorkedOutOnRequestOnly) {
  std::mt19937_64 random(test::seed(38));
  EXPECT_FALSE(fit_batch(steady(0, 0, random)).inertia.at_most.has_value());
}

}  // namespace
}  // namespace steerid
