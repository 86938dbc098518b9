// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The exact step against a fine Runge-Kutta integration that shares nothing with it, and against closed forms; the
// sensitivities against complex-step differentiation of that integration.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>
#include <vector>

#include "plant/linear_response.hpp"
#include "support/seed.hpp"

namespace {

using steerid::TorqueSignal;
using steerid::WheelArm;
using steerid::WheelState;
using Complex = std::complex<double>;

struct ComplexWheel {
  Complex inertia, damping, stiffness, angle, rate, offset;
};

// Classical Runge-Kutta, `substeps` to each interval of `t`, evaluating the torque's own polynomials.
std::vector<Complex> integrate(const ComplexWheel& wheel, const TorqueSignal& torque, const std::vector<double>& t,
                               int substeps) {
  Complex angle = wheel.angle;
  Complex rate = wheel.rate;
  std::vector<Complex> out = {angle};
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double h = (t[i + 1] - t[i]) / substeps;
    const auto acceleration = [&](double tau, Complex th, Complex w) {
      return (torque.piece(i).at(tau) + wheel.offset - wheel.damping * w - wheel.stiffness * th) / wheel.inertia;
    };
    for (int k = 0; k < substeps; ++k) {
      const double tau = k * h;
      const Complex a1 = acceleration(tau, angle, rate);
      const Complex w2 = rate + h / 2 * a1;
      const Complex a2 = acceleration(tau + h / 2, angle + h / 2 * rate, w2);
      const Complex w3 = rate + h / 2 * a2;
      const Complex a3 = acceleration(tau + h / 2, angle + h / 2 * w2, w3);
      const Complex w4 = rate + h * a3;
      const Complex a4 = acceleration(tau + h, angle + h * w3, w4);
      angle += h / 6 * (rate + 2.0 * w2 + 2.0 * w3 + w4);
      rate += h / 6 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    out.push_back(angle);
  }
  return out;
}

struct Case {
  const char* what;
  WheelArm wheel;
};

const Case kCases[] = {
    {"underdamped", {0.11, 1.5, 22.7}},
    {"lightly damped", {0.02, 0.1, 80.5}},
    {"overdamped, table II", {0.11, 2.9, 10.2}},
    {"critical", {0.1, 2.0, 10.0}},
    {"stiff pole, 220/s", {0.02, 4.4, 4.5}},
    {"no stiffness", {0.05, 0.4, 0}},
    {"no damping", {0.11, 0, 22.7}},
    {"inertia alone", {0.05, 0, 0}},
    {"small negative stiffness", {0.11, 1.5, -0.5}},
};

std::vector<double> jittered_times(std::size_t count, std::uint64_t seed, double jitter) {
  std::mt19937_64 random(seed);
  std::vector<double> t;
  for (std::size_t i = 0; i < count; ++i) {
    const double uniform = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
    t.push_back(0.01 * (static_cast<double>(i) + jitter * uniform));
  }
  return t;
}

TorqueSignal some_torque(const std::vector<double>& t) {
  std::vector<double> u;
  for (const double x : t) u.push_back(1.5 * std::sin(9 * x) + 0.7 * std::cos(31 * x) + 0.1);
  return TorqueSignal::from_samples(t, u, TorqueSignal::Between::kBandLimited);
}

double largest(const std::vector<Complex>& values) {
  double out = 0;
  for (const Complex& v : values) out = std::max(out, std::abs(v));
  return out;
}

TEST(LinearResponse, FreeRunMatchesFineIntegration) {
  for (const double jitter : {0.0, 0.8}) {
    const std::vector<double> t = jittered_times(301, 7, jitter);
    const TorqueSignal torque = some_torque(t);
    for (const Case& c : kCases) {
      const WheelState initial{0.2, -1.0};
      const std::vector<Complex> expected =
          integrate({c.wheel.inertia_kgm2, c.wheel.damping_nms_per_rad, c.wheel.stiffness_nm_per_rad, initial.angle_rad,
                     initial.rate_rad_s, 0.3},
                    torque, t, 200);
      const std::vector<double> actual = steerid::free_run(c.wheel, torque, t, initial, 0.3);
      // Runge-Kutta's own error: (220/s * 50 us)^4 * 220 * 3 s / 120 = 1e-7 of a mode that dies within one sample, and
      // below 1e-10 for the other cases.
      const double tolerance = 2e-10 * largest(expected);
      for (std::size_t i = 0; i < t.size(); ++i) {
        ASSERT_NEAR(actual[i], expected[i].real(), tolerance) << c.what << " at " << i << " jitter " << jitter;
      }
    }
  }
}

TEST(LinearResponse, SensitivitiesMatchComplexStep) {
  const std::vector<double> t = jittered_times(201, 3, 0.5);
  const TorqueSignal torque = some_torque(t);
  const WheelState initial{0.2, -1.0};
  for (const Case& c : kCases) {
    steerid::FreeRunSensitivities actual;
    steerid::free_run_sensitivities(c.wheel, torque, t, initial, 0.3, actual);
    for (int column = 0; column < steerid::kSensitivityColumns; ++column) {
      constexpr double kStep = 1e-30;  // no difference is formed, so no digits are lost
      ComplexWheel wheel{c.wheel.inertia_kgm2, c.wheel.damping_nms_per_rad, c.wheel.stiffness_nm_per_rad,
                         initial.angle_rad,    initial.rate_rad_s,          0.3};
      Complex* const fields[] = {&wheel.inertia, &wheel.damping, &wheel.stiffness,
                                 &wheel.angle,   &wheel.rate,    &wheel.offset};
      *fields[column] += Complex(0, kStep);
      const std::vector<Complex> run = integrate(wheel, torque, t, 200);
      double scale = 0;
      for (const Complex& v : run) scale = std::max(scale, std::abs(v.imag()) / kStep);
      for (std::size_t i = 0; i < t.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        ASSERT_NEAR(actual.by(row, column), run[i].imag() / kStep, 1e-8 * scale)
            << c.what << " column " << column << " at " << i;
        ASSERT_NEAR(actual.angle_rad[row], run[i].real(), 1e-8 * largest(run)) << c.what;
      }
    }
  }
}

// Central differences of the model itself: the derivative belongs to the very function that is being fitted.
TEST(LinearResponse, SensitivitiesMatchCentralDifferences) {
  const std::vector<double> t = jittered_times(501, 5, 0.0);
  const TorqueSignal torque = some_torque(t);
  const WheelArm wheel{0.11, 1.5, 22.7};
  steerid::FreeRunSensitivities actual;
  steerid::free_run_sensitivities(wheel, torque, t, {0.1, 0.2}, 0, actual);
  const auto difference = [&](double WheelArm::*field, int column) {
    const double h = 1e-5 * wheel.*field;
    WheelArm more = wheel;
    WheelArm less = wheel;
    more.*field += h;
    less.*field -= h;
    const std::vector<double> a = steerid::free_run(more, torque, t, {0.1, 0.2});
    const std::vector<double> b = steerid::free_run(less, torque, t, {0.1, 0.2});
    const double scale = actual.by.col(column).cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < t.size(); ++i) {
      // second-order truncation h^2 and cancellation eps/h are both near 1e-10
      ASSERT_NEAR(actual.by(static_cast<Eigen::Index>(i), column), (a[i] - b[i]) / (2 * h), 1e-8 * scale);
    }
  };
  difference(&WheelArm::inertia_kgm2, steerid::kByInertia);
  difference(&WheelArm::damping_nms_per_rad, steerid::kByDamping);
  difference(&WheelArm::stiffness_nm_per_rad, steerid::kByStiffness);
}

TEST(LinearResponse, FreeDecayIsTheClosedForm) {
  const double a = 1.5 / 0.22;
  const double w = std::sqrt(22.7 / 0.11 - a * a);
  for (const double dt : {1e-6, 0.001, 0.01, 0.1, 1.0, 10.0}) {
    const steerid::LinearStep step({0.11, 1.5, 22.7}, dt);
    const double decay = std::exp(-a * dt);
    EXPECT_NEAR(step.transition(0, 0), decay * (std::cos(w * dt) + a / w * std::sin(w * dt)), 1e-13) << dt;
    EXPECT_NEAR(step.transition(0, 1), decay * std::sin(w * dt) / w, 1e-14) << dt;
    EXPECT_NEAR(step.transition(1, 1), decay * (std::cos(w * dt) - a / w * std::sin(w * dt)), 1e-13) << dt;
    // constant torque: th = (1 - h1)/C
    EXPECT_NEAR(step.input(0, 0), (1 - step.transition(0, 0)) / 22.7, 1e-14) << dt;
  }
  const steerid::LinearStep critical({0.1, 2.0, 10.0}, 0.05);  // double pole at -10/s
  EXPECT_NEAR(critical.transition(0, 0), std::exp(-0.5) * 1.5, 1e-14);
  EXPECT_NEAR(critical.transition(0, 1), std::exp(-0.5) * 0.05, 1e-15);
  const steerid::LinearStep mass({0.05, 0, 0}, 0.02);  // th = T t^5/20/J for T = t^3
  EXPECT_NEAR(mass.input(0, 3), std::pow(0.02, 5) / 20 / 0.05, 1e-24);
}

// The samples at which the angle is wanted need not be those at which the torque was measured.
TEST(LinearResponse, SampleTimesAreFree) {
  const std::vector<double> knots = jittered_times(101, 11, 0.6);
  const TorqueSignal torque = some_torque(knots);
  const WheelArm wheel{0.11, 1.5, 22.7};
  const std::vector<double> on_knots = steerid::free_run(wheel, torque, knots, {0.1, 0});
  std::vector<double> denser;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    denser.push_back(knots[i]);
    denser.push_back(knots[i] + 0.3 * (knots[i + 1] - knots[i]));
  }
  const std::vector<double> on_denser = steerid::free_run(wheel, torque, denser, {0.1, 0});
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) EXPECT_NEAR(on_denser[2 * i], on_knots[i], 1e-14);
  const std::vector<double> sparse = {knots.front(), knots[40], knots.back() + 0.5};  // past the end: last value holds
  const std::vector<WheelState> on_sparse = steerid::free_run_states(wheel, torque, sparse, {0.1, 0});
  EXPECT_NEAR(on_sparse[1].angle_rad, on_knots[40], 1e-13);
  // A free run continues from where another one stopped.
  const std::vector<double> rest = {knots[40], knots.back() + 0.5};
  EXPECT_NEAR(steerid::free_run(wheel, torque, rest, on_sparse[1])[1], on_sparse[2].angle_rad, 1e-13);
}

}  // namespace
