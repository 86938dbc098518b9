// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The noise through the wheel against its spectrum: closed forms, sums over frequency, and series made of lines.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "fit/lagged_products.hpp"
#include "fit/residual_colour.hpp"
#include "fit/wheel_noise.hpp"
#include "support/seed.hpp"

namespace {

using steerid::Autoregression;
using steerid::WheelArm;
using Complex = std::complex<double>;

constexpr double kPi = std::numbers::pi;
constexpr double kPeriod_s = 0.01;
constexpr WheelArm kRelaxed = {0.06, 0.4, 2.0};

double gain_squared(const WheelArm& wheel, double f_hz) {
  const Complex s(0, 2 * kPi * f_hz);
  return std::norm(1.0 / (wheel.inertia_kgm2 * s * s + wheel.damping_nms_per_rad * s + wheel.stiffness_nm_per_rad));
}

double slow_shape(double corner_hz, int low_passes, double f_hz) {
  return 1 / std::pow(1 + f_hz * f_hz / (corner_hz * corner_hz), low_passes);
}

/// Per-sample density of angle noise `angle` rad, torque noise `torque` Nm and a slow torque as dense as `slow` Nm at
/// rest.
struct Spectrum {
  double angle, torque, slow, corner_hz;
  int low_passes = 2;
  double operator()(double f_hz) const {
    const double slow_power = slow * slow * slow_shape(corner_hz, low_passes, f_hz);
    return angle * angle + gain_squared(kRelaxed, f_hz) * (torque * torque + slow_power);
  }
};

/// A series of that spectrum below half the sample rate: lines 1/80 Hz apart, normal amplitudes.
Eigen::VectorXd series(const Spectrum& spectrum, Eigen::Index samples, std::mt19937_64& random) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  constexpr double kSpacing_hz = 1.0 / 80;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(samples);
  for (int k = 1; k < 4000; ++k) {
    const double f = k * kSpacing_hz;
    const double size = std::sqrt(-2 * std::log(uniform()) * spectrum(f) * 2 * kPeriod_s * kSpacing_hz);
    Complex phasor = std::polar(size, 2 * kPi * uniform());
    const Complex turn = std::polar(1.0, 2 * kPi * f * kPeriod_s);
    for (double& v : out) {
      v += phasor.real();
      phasor *= turn;
    }
  }
  return out;
}

double modelled(const Autoregression& model, double f_hz) {
  Complex sum = 1;
  for (int k = 1; k <= model.order(); ++k) {
    sum += model.coefficients()[static_cast<std::size_t>(k - 1)] * std::polar(1.0, -2 * kPi * f_hz * kPeriod_s * k);
  }
  return 1 / std::norm(sum);
}

// Papoulis: white torque of density q on an underdamped wheel: q/(2 B C) e^(-d t) (cos w t + d/w sin w t).
TEST(WheelNoise, WhiteTorqueHasItsClosedForm) {
  const std::vector<double> c = steerid::angle_autocovariance(kRelaxed, 0, 0, kPeriod_s, 200);
  const double d = kRelaxed.damping_nms_per_rad / (2 * kRelaxed.inertia_kgm2);
  const double w = std::sqrt(kRelaxed.stiffness_nm_per_rad / kRelaxed.inertia_kgm2 - d * d);
  const double power = kPeriod_s / (2 * kRelaxed.damping_nms_per_rad * kRelaxed.stiffness_nm_per_rad);
  ASSERT_EQ(c.size(), 201U);
  for (std::size_t k = 0; k < c.size(); ++k) {
    const double t = static_cast<double>(k) * kPeriod_s;
    EXPECT_NEAR(c[k], power * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t)), 1e-11 * power) << k;
  }
}

TEST(WheelNoise, SlowTorqueHasTheTransformOfItsSpectrum) {
  constexpr double kCorner_hz = 0.3;
  for (const WheelArm& wheel : {kRelaxed, WheelArm{0.11, 1.5, 22.7}, WheelArm{0.1, 2.0, 10.0}}) {  // the last: critical
    for (const int low_passes : {1, 2}) {
      const std::vector<double> c = steerid::angle_autocovariance(wheel, kCorner_hz, low_passes, kPeriod_s, 100);
      constexpr double kStep_hz = 1e-3;
      for (const std::size_t k : {0U, 1U, 7U, 30U, 100U}) {
        double sum = 0.5 * gain_squared(wheel, 0);  // trapezoids: exact but for what lies above 40 Hz, below 1e-9
        for (int i = 1; i < 40000; ++i) {
          const double f = i * kStep_hz;
          sum += gain_squared(wheel, f) * slow_shape(kCorner_hz, low_passes, f) *
                 std::cos(2 * kPi * f * static_cast<double>(k) * kPeriod_s);
        }
        EXPECT_NEAR(c[k], 2 * kStep_hz * kPeriod_s * sum, 1e-6 * c[0]) << low_passes << ", " << k;
      }
    }
  }
}

// The densities span three decades. From 60 s the sensors' levels are known to 5 to 10 %; the slow torque's, from some
// 60 lines below 1 Hz, to 15 %, and its corner, 0.3 Hz (0.2 Hz with one low pass), is not among those tried, which
// bends the slope below 2 Hz by up to 2^(1/2). Three deviations and the bend: a factor of 1.6.
TEST(WheelNoise, FindsTheSpectrum) {
  std::mt19937_64 random(steerid::test::seed(31));
  for (const Spectrum& spectrum : {Spectrum{5e-4, 0.03, 0, 1}, Spectrum{1.7e-3, 0.03, 0, 1},
                                   Spectrum{5e-4, 0.03, 1, 0.3}, Spectrum{5e-4, 0.03, 1, 0.2, 1}}) {
    const std::vector<Eigen::VectorXd> residual = {series(spectrum, 6000, random)};
    const auto model = steerid::wheel_noise({residual, {}, 100}, kRelaxed, kPeriod_s);
    ASSERT_TRUE(model);
    for (const double f : {0.5, 0.9, 1.5, 3.0, 6.0, 12.0}) {
      const double ratio = modelled(*model, f) / modelled(*model, 25) * spectrum(25) / spectrum(f);
      EXPECT_LT(std::abs(std::log(ratio)), std::log(1.6)) << f << " Hz";
    }
  }
}

TEST(WheelNoise, HasNothingToSayOfAWheelThatDoesNotComeToRest) {
  std::mt19937_64 random(steerid::test::seed(34));
  const std::vector<Eigen::VectorXd> residual = {series({5e-4, 0.03, 0, 1}, 2000, random)};
  for (const WheelArm& wheel : {WheelArm{0.06, -0.1, 2}, WheelArm{0.06, 0.4, 0}, WheelArm{0.06, 0.4, -1}}) {
    EXPECT_FALSE(steerid::wheel_noise({residual, {}, 100}, wheel, kPeriod_s));
  }
}

TEST(ResidualColour, IsThatOfTheWheelWhereTheWheelExplainsIt) {
  std::mt19937_64 random(steerid::test::seed(32));
  const std::vector<Eigen::VectorXd> residual = {series({5e-4, 0.03, 1, 0.3}, 6000, random)};
  const Autoregression colour = steerid::residual_colour(residual, {}, kRelaxed, kPeriod_s, {30, 100});
  EXPECT_EQ(colour.numbers(), 3);  // two shares and the slow torque's corner
}

// A line of 9 Hz that no wheel of 0.9 Hz passes on.
TEST(ResidualColour, IsFreeWhereItHoldsMore) {
  std::mt19937_64 random(steerid::test::seed(33));
  std::vector<Eigen::VectorXd> residual = {series({5e-4, 0.03, 1, 0.3}, 6000, random)};
  for (Eigen::Index i = 0; i < residual[0].size(); ++i) {
    residual[0][i] += 1e-3 * std::sin(2 * kPi * 9 * kPeriod_s * static_cast<double>(i));
  }
  const Autoregression colour = steerid::residual_colour(residual, {}, kRelaxed, kPeriod_s, {30, 100});
  EXPECT_EQ(colour.numbers(), colour.order());
  EXPECT_GT(modelled(colour, 9), 5 * modelled(colour, 15));
}

}  // namespace
