// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The response of a wheel with several effects, against the equations of compliance's two masses, solved line by line.
#include "gap/model/parts_response.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "gap/compared_drive.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/model/point.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/model/spectral_model.hpp"
#include "gap/sets/set_fit.hpp"
#include "gap/sets/set_moves.hpp"
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

/// A lag of the angle's channel filters what is recorded of the wheel, whatever moves that; a torque that was worked
/// out on the recorded motion has passed it already. A delay makes the recorded torque late.
TEST(PartsResponse, KeepsTheChannelApart) {
  constexpr double kLag_s = 0.03;
  const Eigen::VectorXd omega = Eigen::VectorXd::LinSpaced(40, 1, 80);
  Response out;
  EXPECT_EQ(set_parts_response(with_compliance(effect::lag, kLag_s), omega, out), 0);
  for (Eigen::Index k = 0; k < omega.size(); ++k) {
    const std::complex<double> lag(1, omega[k] * kLag_s);
    EXPECT_LT(std::abs(out.gain[k] * lag / two_masses(omega[k]) - 1.0), 1e-12);
    EXPECT_LT(std::abs(out.gain_on_motion()[k] / two_masses(omega[k]) - 1.0), 1e-12);
    EXPECT_EQ(out.late[k], 1.0);
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

/// Whatever else is there: noise would pass otherwise where nothing moves the wheel otherwise, and a set with one
/// effect more would be nearer or further for that.
TEST(PartsResponse, AnEffectOfNoSizeChangesNoLikelihood) {
  test::DrawnDrive what;
  what.lag_s = 0.04;
  const test::ComparedDrive compared(what, test::seed(64));
  Point with_lag{what.wheel, {Effect(effect::lag)}};
  with_lag.effects[0].values = {what.lag_s};
  Point with_delay{what.wheel, {Effect(effect::delay)}};
  with_delay.effects[0].values = {what.lag_s};
  for (const Point& at : {Point{what.wheel, {}}, with_lag, with_delay, with_compliance(effect::lag, what.lag_s)}) {
    const auto cost = [&](const Point& of) {
      const Parts parts = hypotheses_of(of.effects);
      SpectralModel on_motion(compared.spectral, parts);
      SimulatedModel by_runs(compared.spectral, parts);
      return std::array{compared.judged(on_motion, of.numbers(), parts).over(kFitted).cost,
                        compared.judged(by_runs, of.numbers(), parts).over(kFitted).cost};
    };
    const auto [on_motion, by_runs] = cost(at);
    int sizes = 0;
    for (const auto& hypothesis : hypotheses()) {
      if (!hypothesis->acts() || hypothesis->timed()) continue;  // of a time the first number is not the size
      if (!goes_with(hypothesis->type(), at.effects)) continue;
      Point beside = at;
      Effect& none = beside.effects.emplace_back(hypothesis->type());
      none.values[0] = 0;
      if (&hypothesis->type() == &effect::asymmetric_friction) none.values[1] = 0;
      ++sizes;
      const auto [of_motion, of_runs] = cost(beside);
      EXPECT_NEAR(of_motion, on_motion, 1e-6) << hypothesis->type().id << " beside " << at.effects.size();
      EXPECT_NEAR(of_runs, by_runs, 0.1 + 1e-4 * std::abs(by_runs))
          << hypothesis->type().id << " beside " << at.effects.size();
    }
    EXPECT_GT(sizes, 8);
  }
}

/// A tone of the time alone is recorded as late as the applied torque: its numbers are those of the torque, not those
/// that the angle's channel shows.
TEST(PartsResponse, AToneIsStatedAsTheTorqueThatItIs) {
  constexpr double kTone_nm = 0.2;
  constexpr double kTone_hz = 5;  // whole periods in the 3 s that the drive begins before its record
  constexpr double kPhase_rad = 0.7;
  constexpr double kLate_s = 0.05;
  for (const EffectType* late : {&effect::lag, &effect::delay}) {
    test::DrawnDrive what;
    (late == &effect::lag ? what.lag_s : what.delay_s) = kLate_s;
    what.torque = [](double t, double, double) {
      return kTone_nm * std::sin(2 * std::numbers::pi * kTone_hz * t + kPhase_rad);
    };
    const test::ComparedDrive compared(what, test::seed(65));
    const SetFitter fitter(compared.setting);
    const EffectSet set = with_added(test::ComparedDrive::with(*late), *hypothesis_of(effect::periodic_disturbance));
    Point start{what.wheel, {Effect(*late), Effect(effect::periodic_disturbance)}};
    start.effects[0].values = {kLate_s};
    start.effects[1].values = {kTone_nm, kTone_hz, 0};
    const Point found = fitter.fit(set, start).at();
    const Effect& tone = *found.find(effect::periodic_disturbance);
    EXPECT_NEAR(tone.at("amplitude_nm"), kTone_nm, 0.02 * kTone_nm) << late->id;
    EXPECT_NEAR(tone.at("phase_rad"), kPhase_rad, 0.05) << late->id;
  }
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
