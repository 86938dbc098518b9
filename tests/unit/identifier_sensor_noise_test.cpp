// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Sensor noise read off a drive, and what it makes of the model's motion, against closed forms and integrals.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "identifier/noise_information.hpp"
#include "identifier/sensor_noise.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// One estimate is a mean of squares of sixth differences over N = 1000 samples; their correlation at lag k is
// C(12, 6 + k) / C(12, 6), so that the relative variance is 2/N C(24,12)/C(12,6)^2 = 2/N 3.167. Averaged over 100
// estimates: sd 0.80 %. The limit is four of them, on both sides.
TEST(SensorNoise, FindsTheVarianceOfWhiteNoise) {
  std::mt19937_64 random(test::seed(5));
  std::normal_distribution<double> normal;
  double mean = 0;
  double square = 0;
  for (int run = 0; run < 100; ++run) {
    SensorNoise<double> noise;
    for (int k = 0; k < 1006; ++k) noise.push(3.0 + 0.0007 * normal(random));
    const double relative = noise.variance() / (0.0007 * 0.0007);
    mean += relative / 100;
    square += relative * relative / 100;
  }
  EXPECT_NEAR(mean, 1.0, 4 * 0.0080);
  // And it scatters as it should; the sd of a sd from 100 runs is 7 %.
  EXPECT_NEAR(std::sqrt(square - mean * mean) / std::sqrt(2 * 3.167 / 1000), 1.0, 0.28);
}

// A converter's step q is noise of variance q^2/12 (Widrow) once the noise before it spans the step. Averages over 20
// runs: sd 1.8 %, four of them.
TEST(SensorNoise, TakesResolutionForTheNoiseThatItAmountsTo) {
  std::mt19937_64 random(test::seed(6));
  std::normal_distribution<double> normal;
  double mean = 0;
  for (int run = 0; run < 20; ++run) {
    SensorNoise<double> noise;
    for (int k = 0; k < 1006; ++k) {
      noise.push(std::nearbyint(0.3 * std::sin(kTurn * 0.5 * 0.01 * k) / 0.0005 + 1.4 * normal(random)) * 0.0005);
    }
    mean += noise.variance() / 20;
  }
  EXPECT_NEAR(mean / (0.0005 * 0.0005 * (1.4 * 1.4 + 1.0 / 12)), 1.0, 4 * 0.018);
}

// (2 sin(pi f T))^12 / 924 of a sine's power comes through: at 5 Hz 9.5e-10, five tenths of a milliradian for a whole
// one. The estimate sees whole periods, and only rounding differs.
TEST(SensorNoise, LetsThroughOfASineWhatItsHeaderStates) {
  SensorNoise<double> noise;
  for (int k = 0; k < 1006; ++k) noise.push(std::sin(kTurn * 5 * 0.01 * k));
  const double share = std::pow(2 * std::sin(std::numbers::pi * 0.05), 12) / 924;
  EXPECT_NEAR(noise.variance() / (0.5 * share), 1.0, 0.01);
  EXPECT_NEAR(std::pow(2 * std::sin(std::numbers::pi * 0.05), 6), 0.001, 0.0001);
}

TEST(SensorNoise, DoesNotDifferenceAcrossAGap) {
  std::mt19937_64 random(test::seed(7));
  std::normal_distribution<double> normal;
  SensorNoise<double> noise;
  for (int k = 0; k < 2000; ++k) {
    if (k == 1000) noise.break_here();
    noise.push((k < 1000 ? 0.0 : 50.0) + 0.001 * normal(random));
  }
  EXPECT_NEAR(noise.variance() / 1e-6, 1.0, 4 * 0.08);  // one estimate: sd 8 %
}

TEST(SensorNoise, IsMovedLittleByOneWildSample) {
  std::mt19937_64 random(test::seed(8));
  std::normal_distribution<double> normal;
  SensorNoise<double> noise;
  for (int k = 0; k < 2000; ++k) noise.push((k == 1500 ? 1.0 : 0.0) + 0.001 * normal(random));
  // Seven differences hold it, each counts 25 variances at most: + 17.5 %, beside the 8 % of chance.
  EXPECT_LT(noise.variance() / 1e-6, 1.175 + 4 * 0.08);
}

// What the torque sensor's noise makes of the model's motion, against the integral over all frequencies; the arms from
// relaxed to braced. Without the whitening filter the closed form is the integral; behind it one frequency stands for a
// band.
TEST(NoiseInformation, IsTheIntegralOfTheSpectrum) {
  constexpr double kArms[][3] = {
      {0.06, 0.4, 2.0}, {0.11, 1.5, 22.7}, {0.11, 2.1, 45.9}, {0.18, 4.4, 4.5}, {0.11, 0.7, 17.0}};
  for (const auto& arm : kArms) {
    for (const double corner_hz : {2.5, 6.0}) {
      for (const double depth : {0.0, 0.4, 0.7, 0.85, 0.93}) {
        const double a0 = kTurn * corner_hz * kTurn * corner_hz;
        const double a1 = 1.4 * kTurn * corner_hz;
        const auto whitening = WhiteningShape<double>::of_depth(depth);
        const double corner = kTurn * 0.3;
        const double end = corner / (1 - depth);
        const double damping = std::sqrt(2 * (1 + (1 - depth) * (1 - depth)));
        double integral[3] = {};
        constexpr int kSteps = 4000;
        const double ratio = std::pow(5e4, 1.0 / kSteps);  // 1e-3 to 50 Hz
        double w = kTurn * 1e-3;
        for (int k = 0; k < kSteps; ++k, w *= ratio) {
          const std::complex<double> s(0, w);
          const auto filter = a0 / (s * s + a1 * s + a0);
          const auto wheel = 1.0 / (arm[0] * s * s + arm[1] * s + arm[2]);
          const auto response = (s + corner) * (s + corner) / (s * s + damping * end * s + end * end);
          // White noise of variance 1 at 100 Hz has the two-sided density 0.01; dw = w (ratio - 1).
          const double density = 0.01 * std::norm(filter * wheel * response) * w * (ratio - 1) / (kTurn / 2);
          integral[0] += density;
          integral[1] += density * w * w;
          integral[2] += density * w * w * w * w;
        }
        const auto says =
            noise_information<double>(Eigen::Vector3d(arm[0], arm[1], arm[2]), a0, a1, 1.0, 0.01, whitening);
        const double got[3] = {says.angle / integral[0], says.rate / integral[1], says.acceleration / integral[2]};
        for (const double& share : got) {
          EXPECT_LT(share, depth > 0 ? 3.5 : 1.01) << arm[2] << " " << corner_hz << " " << depth;
          EXPECT_GT(share, depth > 0 ? 1.0 / 3.5 : 0.99) << arm[2] << " " << corner_hz << " " << depth;
        }
      }
    }
  }
}

}  // namespace
}  // namespace steerid
