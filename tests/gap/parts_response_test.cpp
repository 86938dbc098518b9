// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The response of a wheel with several effects, against the equations of compliance's two masses, solved line by line.
#include "gap/model/parts_response.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <complex>
#include <vector>

#include "gap/drawn_drive.hpp"
#include "gap/model/point.hpp"
#include "gap/model/simulated_model.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr double kInertia = 0.14;
constexpr double kDamping = 1.2;
constexpr double kStiffness = 45;
constexpr double kGripStiffness = 150;
constexpr double kGripDamping = 0.5;

/// The wheel's angle per torque on it: wheel (a quarter of J, a tenth of B) and arm with the grip between them.
std::complex<double> two_masses(double w) {
  const std::complex<double> s(0, w);
  const std::complex<double> grip = kGripStiffness + kGripDamping * s;
  Eigen::Matrix2cd stiffness;
  stiffness << 0.25 * kInertia * s * s + 0.1 * kDamping * s + grip, -grip, -grip,
      0.75 * kInertia * s * s + 0.9 * kDamping * s + kStiffness + grip;
  return (stiffness.inverse() * Eigen::Vector2cd(1, 0))[0];
}

Point with_compliance(const EffectType& other, double value) {
  Point at{{kInertia, kDamping, kStiffness}, {Effect(effect::compliance), Effect(other)}};
  at.effects[0].values = {kGripStiffness, kGripDamping, 0.25, 0.1};
  at.effects[1].values = {value};
  return at;
}

TEST(PartsResponse, IsThatOfComplianceWhateverActsBesideIt) {
  const Eigen::VectorXd omega = Eigen::VectorXd::LinSpaced(40, 1, 80);
  Response out;
  EXPECT_EQ(set_parts_response(with_compliance(effect::cubic_stiffness, 12), omega, out), 0);
  for (Eigen::Index k = 0; k < omega.size(); ++k) {
    EXPECT_LT(std::abs(out.gain[k] / two_masses(omega[k]) - 1.0), 1e-12);
    EXPECT_EQ(out.late[k], 1.0);
  }
}

/// A lag and a delay of the angle's channel do not filter what a torque makes of the wheel, but what is recorded of it.
TEST(PartsResponse, KeepsTheChannelApart) {
  constexpr double kLag_s = 0.03;
  const Eigen::VectorXd omega = Eigen::VectorXd::LinSpaced(40, 1, 80);
  Response out;
  EXPECT_EQ(set_parts_response(with_compliance(effect::lag, kLag_s), omega, out), 0);
  for (Eigen::Index k = 0; k < omega.size(); ++k) {
    EXPECT_LT(std::abs(out.gain[k] / two_masses(omega[k]) - 1.0), 1e-12);
    EXPECT_LT(std::abs(out.late[k] * std::complex<double>(1, omega[k] * kLag_s) - 1.0), 1e-12);
  }
  EXPECT_EQ(set_parts_response(with_compliance(effect::delay, 0.04), omega, out), 0.04);
  EXPECT_EQ(out.late, Spectrum::Constant(omega.size(), 1.0));
}

/// The noise of a run passes through the compliance, too: a rigid one would take ten times as much of it for
/// noise at the grip's resonance, and far less above.
TEST(PartsResponse, IsWhatTheNoiseOfARunPasses) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(62));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record), false);
  const Point at = with_compliance(effect::cubic_stiffness, 0);
  SimulatedModel model(spectral, hypotheses_of(at.effects));
  Spectrum residual;
  Response response;
  model.evaluate(at.numbers(), residual, response);
  double apart = 0;
  for (Eigen::Index k = 0; k < response.gain.size(); ++k) {
    const double w = spectral.spectra.omega()[k];
    if (w == 0) continue;
    EXPECT_LT(std::abs(response.gain[k] / two_masses(w) - 1.0), 1e-12);
    const std::complex<double> rigid = wheel_response({kInertia, kDamping, kStiffness}, w);
    apart = std::max(apart, std::abs(two_masses(w) / rigid));
  }
  EXPECT_GT(apart, 2);  // so that the rigid wheel's would not pass
}

/// What is said to be felt, against differences of the torque where the whole motion is moved by a little.
TEST(PartsResponse, WhatNoiseFeelsIsTheMeanSlopeOfTheTorque) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(63));
  const MeasuredMotion motion = measured_motion(record, what.wheel);
  int felt_ones = 0;
  for (const auto& hypothesis : hypotheses()) {
    std::vector<double> values;
    for (const Parameter& parameter : hypothesis->type().parameters) values.push_back(parameter.preset);
    const WheelArm felt = hypothesis->felt_by_noise(values.data(), motion);
    if (felt.damping_nms_per_rad == 0 && felt.stiffness_nm_per_rad == 0) continue;
    ++felt_ones;
    const auto mean_nm = [&](double angle_rad, double rate_rad_s) {
      MeasuredMotion moved = motion;
      for (double& angle : moved.angle_rad) angle += angle_rad;
      for (double& rate : moved.rate_rad_s) rate += rate_rad_s;
      std::vector<double> torque(record.size());
      hypothesis->torque(what.wheel, values.data(), record, moved, torque);
      double sum = 0;
      for (const double one : torque) sum += one;
      return sum / static_cast<double>(torque.size());
    };
    constexpr double kMoved = 1e-4;
    // |v|v bends at zero: of the slope a part of kMoved over the largest rate is lost.
    EXPECT_NEAR(felt.stiffness_nm_per_rad, (mean_nm(-kMoved, 0) - mean_nm(kMoved, 0)) / (2 * kMoved), 1e-3);
    EXPECT_NEAR(felt.damping_nms_per_rad, (mean_nm(0, -kMoved) - mean_nm(0, kMoved)) / (2 * kMoved), 1e-3);
    EXPECT_GT(std::max(felt.damping_nms_per_rad, felt.stiffness_nm_per_rad), 0.1) << hypothesis->type().id;
    EXPECT_EQ(felt.inertia_kgm2, 0);
  }
  EXPECT_EQ(felt_ones, 2);
}

}  // namespace
}  // namespace steerid::gap
