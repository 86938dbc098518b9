// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the torque does between its samples, against sines known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "plant/linear_response.hpp"
#include "plant/torque_signal.hpp"

namespace {

using steerid::TorqueSignal;
using Between = steerid::TorqueSignal::Between;
constexpr double kPi = std::numbers::pi;

std::vector<double> times(std::size_t count, double period_s) {
  std::vector<double> t(count);
  for (std::size_t i = 0; i < count; ++i) t[i] = static_cast<double>(i) * period_s;
  return t;
}

TorqueSignal sampled_sine(double frequency_hz, Between between) {
  const std::vector<double> t = times(3001, 0.01);
  std::vector<double> u(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) u[i] = std::sin(2 * kPi * frequency_hz * t[i]);
  return TorqueSignal::from_samples(t, u, between);
}

// Complex gain of the rebuilt signal at its own frequency: projection on exp(j w t) over ten whole seconds in the
// middle, by the midpoint rule on a grid 64 times finer than the samples. 1 is a perfect reconstruction.
std::complex<double> gain_at(const TorqueSignal& signal, double frequency_hz) {
  constexpr int kPoints = 64'000;
  std::complex<double> sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double t = 10 + 10 * (i + 0.5) / kPoints;
    sum += signal.at(t) * std::polar(1.0, -2 * kPi * frequency_hz * t);
  }
  return sum * (2.0 / kPoints) * std::complex<double>(0, 1);
}

TEST(TorqueSignal, BandLimitedHasNoDelayAndTheDocumentedGainError) {
  for (const double f : {1.0, 5.0, 10.0}) {
    const std::complex<double> gain = gain_at(sampled_sine(f, Between::kBandLimited), f);
    const double predicted = std::pow(2 * kPi * f / 100, 4) / 720;  // leading term of the cubic spline's response
    RecordProperty("gain_error_" + std::to_string(f), std::to_string(std::abs(gain) - 1));
    std::printf("%4.1f Hz: gain error %.3g, predicted magnitude %.3g, phase %.3g rad\n", f, std::abs(gain) - 1,
                predicted, std::arg(gain));
    EXPECT_LT(std::abs(std::abs(gain) - 1), 1.2 * predicted + 1e-9) << f;
    EXPECT_GT(std::abs(std::abs(gain) - 1), 0.8 * predicted - 1e-9) << f;
    EXPECT_NEAR(std::arg(gain), 0, 1e-9) << f;  // 1e-9 rad of a 5 Hz sine is 3e-11 s
  }
}

TEST(TorqueSignal, HeldLagsByExactlyHalfASample) {
  for (const double f : {1.0, 5.0, 10.0}) {
    const std::complex<double> gain = gain_at(sampled_sine(f, Between::kHeld), f);
    const double half_angle = kPi * f / 100;  // zero-order hold: sinc(f/fs) exp(-j pi f/fs)
    EXPECT_NEAR(std::arg(gain), -half_angle, 1e-9) << f;
    EXPECT_NEAR(std::abs(gain), std::sin(half_angle) / half_angle, 5e-6) << f;  // midpoint rule: (0.01 w/64)^2/24
  }
}

// The same through the wheel: a 5 Hz torque must come out with the amplitude and phase of 1/(J s^2 + B s + C).
TEST(TorqueSignal, FiveHertzThroughTheWheelKeepsItsPhase) {
  const steerid::WheelArm wheel{0.11, 1.5, 22.7};
  const std::complex<double> s(0, 2 * kPi * 5);
  const std::complex<double> expected =
      1.0 / (wheel.inertia_kgm2 * s * s + wheel.damping_nms_per_rad * s + wheel.stiffness_nm_per_rad);
  const auto response = [&](Between between) {
    const TorqueSignal torque = sampled_sine(5, between);
    const std::vector<double> t = times(3001, 0.01);
    const std::vector<double> angle = steerid::free_run(wheel, torque, t, {});
    std::complex<double> sum = 0;
    for (std::size_t i = 2000; i < 3000; ++i) sum += angle[i] * std::polar(1.0, -2 * kPi * 5 * t[i]);
    return sum * 2e-3 * std::complex<double>(0, 1);
  };
  const std::complex<double> smooth = response(Between::kBandLimited) / expected;
  EXPECT_NEAR(std::abs(smooth), 1, 2e-5);  // 1.4e-5 predicted
  EXPECT_NEAR(std::arg(smooth), 0, 1e-5);  // aliases near 95 Hz fold back, attenuated by the wheel
  const std::complex<double> held = response(Between::kHeld) / expected;
  EXPECT_NEAR(std::arg(held), -kPi * 5 / 100, 0.01 * kPi * 5 / 100);
}

TEST(TorqueSignal, ReproducesCubicsOnUnequalTimesExactly) {
  const std::vector<double> t = {0.0, 0.01, 0.013, 0.04, 0.05, 0.09, 0.1};
  const auto cubic = [](double x) { return 0.3 - 2 * x + 40 * x * x - 700 * x * x * x; };
  std::vector<double> u;
  for (const double x : t) u.push_back(cubic(x));
  const TorqueSignal signal = TorqueSignal::from_samples(t, u, Between::kBandLimited);
  ASSERT_EQ(signal.pieces(), t.size() - 1);
  for (double x = 0.0005; x < 0.1; x += 0.001) EXPECT_NEAR(signal.at(x), cubic(x), 1e-13) << x;
}

TEST(TorqueSignal, IsContinuousUpToItsSecondDerivative) {
  const std::vector<double> t = {0.0, 0.01, 0.02, 0.035, 0.04, 0.06};
  const std::vector<double> u = {0.0, 1.0, -1.0, 2.0, 0.5, 0.25};
  const TorqueSignal signal = TorqueSignal::from_samples(t, u, Between::kBandLimited);
  for (std::size_t k = 0; k + 1 < signal.pieces(); ++k) {
    const steerid::Cubic end = signal.piece(k).shifted(t[k + 1] - t[k]);
    const steerid::Cubic next = signal.piece(k + 1);
    EXPECT_NEAR(end.c0, next.c0, 1e-12);
    EXPECT_NEAR(end.c1, next.c1, 1e-9);
    EXPECT_NEAR(end.c2, next.c2, 1e-7);
    EXPECT_DOUBLE_EQ(next.c0, u[k + 1]);
  }
}

TEST(TorqueSignal, ShortRecordsAndEnds) {
  const TorqueSignal one = TorqueSignal::from_samples(std::vector{1.0}, std::vector{2.0}, Between::kBandLimited);
  EXPECT_EQ(one.pieces(), 0U);
  EXPECT_EQ(one.at(0), 2.0);
  EXPECT_EQ(one.at(5), 2.0);
  const TorqueSignal two =
      TorqueSignal::from_samples(std::vector{0.0, 1.0}, std::vector{2.0, 4.0}, Between::kBandLimited);
  EXPECT_DOUBLE_EQ(two.at(0.25), 2.5);
  EXPECT_EQ(two.at(-1), 2.0);  // end values are held
  EXPECT_EQ(two.at(9), 4.0);
  const TorqueSignal three =
      TorqueSignal::from_samples(std::vector{0.0, 1.0, 3.0}, std::vector{0.0, 1.0, 9.0}, Between::kBandLimited);
  EXPECT_NEAR(three.at(2), 4.0, 1e-12);  // the parabola
  const TorqueSignal held = TorqueSignal::from_samples(std::vector{0.0, 1.0}, std::vector{2.0, 4.0}, Between::kHeld);
  EXPECT_EQ(held.at(0.999), 2.0);
  EXPECT_EQ(held.at(1.0), 4.0);
}

TEST(TorqueSignal, RejectsWhatIsNoSignal) {
  const auto make = [](std::vector<double> t, std::vector<double> u) {
    return TorqueSignal::from_samples(t, u, Between::kBandLimited);
  };
  EXPECT_THROW(make({}, {}), std::invalid_argument);
  EXPECT_THROW(make({0, 1}, {0}), std::invalid_argument);
  EXPECT_THROW(make({0, 0}, {0, 1}), std::invalid_argument);
  EXPECT_THROW(make({0, std::nan("")}, {0, 1}), std::invalid_argument);
}

}  // namespace
