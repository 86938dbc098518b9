// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What rounding leaves in a record's lines, held against closed forms: a saw-tooth's harmonics, a constant, white
// noise.
#include "gap/likelihood/rounding_spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/likeliest_changes.hpp"
#include "gap/preparation/prepared_record.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr std::size_t kCount = 2000;
constexpr double kStep_rad = 0.05;

BlockSpectra one_block() { return BlockSpectra(std::vector{Block{Block::Role::kFit, 0, kCount}}); }

TEST(RoundingSpectrum, OfASteadyTurnIsASawTooth) {
  constexpr double kSamplesAStep = 100;  // a step a second: line 20
  std::vector<double> motion(kCount);
  for (std::size_t i = 0; i < kCount; ++i) motion[i] = kStep_rad * static_cast<double>(i) / kSamplesAStep;
  const Eigen::VectorXd power = rounding_spectrum(one_block(), motion, kStep_rad);
  // The m-th harmonic is a sinusoid of amplitude step/(pi m): amplitude^2 N/4 in one line, spread over the lines around
  // it. The higher a line the wider the mean it takes, so that their sum is off by one line in so many.
  const double first = std::pow(kStep_rad / std::numbers::pi, 2) * kCount / 4;
  EXPECT_NEAR(power.segment(14, 13).sum(), first, 0.06 * first);
  EXPECT_NEAR(power.segment(31, 19).sum(), first / 4, 0.12 * first / 4);
  EXPECT_LT(power[10], 1e-4 * first);
}

TEST(RoundingSpectrum, OfAWheelAtRestIsAConstant) {
  const std::vector<double> motion(kCount, 0.3);
  const Eigen::VectorXd power = rounding_spectrum(one_block(), motion, kStep_rad);
  // A constant that lies anywhere within a step: a third of its mean square over three lines. 16 places hold it to 0.4
  // %.
  const double all = kCount * kStep_rad * kStep_rad / 12;
  EXPECT_NEAR(power[0], all / 3, 0.01 * all / 3);
  EXPECT_LT(power[5], 1e-9 * all);
}

TEST(RoundingSpectrum, OfAWheelThatPassesManyStepsASampleIsWhite) {
  test::Noise noise(test::seed(91));
  std::vector<double> motion(kCount);
  for (double& angle : motion) angle = 40 * kStep_rad * noise.uniform();
  const Eigen::VectorXd power = rounding_spectrum(one_block(), motion, kStep_rad);
  const double white = kStep_rad * kStep_rad / 12;
  // 241 lines, at each of which the places give the mean of dependent ones: 1/sqrt(241) is 6 %; five of these.
  EXPECT_NEAR(power.mean(), white, 0.3 * white);
}

/// A slow drive whose angle follows from the wheel's response in closed form, rounded to some seven values.
Record slow_and_coarse(const WheelArm& wheel, std::uint64_t seed) {
  test::Noise noise(seed);
  Record record;
  for (int i = 0; i < 8000; ++i) {
    const double t = 0.01 * i;
    double torque = 0;
    double angle = 0;
    for (const double w : {0.31, 0.83, 2.9}) {
      const std::complex<double> wave = std::polar(1.2, w * t + w * w);
      torque += wave.real();
      angle += (wave / std::complex<double>(wheel.stiffness_nm_per_rad - wheel.inertia_kgm2 * w * w,
                                            wheel.damping_nms_per_rad * w))
                   .real();
    }
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(torque + 0.01 * noise());
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(kStep_rad * std::round((angle + 0.0005 * noise()) / kStep_rad));
  }
  return record;
}

TEST(RoundingSpectrum, PutsTheTrueWheelOfACoarseRecordOnTheFloor) {
  Simulation simulation;
  simulation.wheel = {0.06, 1.2, 20};
  const Record record = slow_and_coarse(simulation.wheel, test::seed(92));
  const auto excess = [&](const std::vector<std::string>& without) {
    const PreparedRecord prepared(record, simulation, without);
    SpectralModel model(*prepared.spectral, {});
    Eigen::VectorXd x(3);
    x << simulation.wheel.inertia_kgm2, simulation.wheel.damping_nms_per_rad, simulation.wheel.stiffness_nm_per_rad;
    const auto fitted = fitted_parameters(simulation.wheel, {});
    return prepared.whittle->judge(model, x, fitted, kSeen, SlowTorque::kFloor).excess(kSeen);
  };
  // Some 450 lines in which few saw-teeth are: twice or half as much is no surprise. White noise of the level above 15
  // Hz expects a tenth.
  const double modelled = excess({});
  EXPECT_GT(modelled, 0.5);
  EXPECT_LT(modelled, 1.5);
  EXPECT_GT(excess({"coarse_quantization"}), 4);
}

Record coarse_drive(const test::DrawnDrive& what, std::uint64_t seed) {
  Record record = test::drive(what, seed);
  for (double& angle : record.angle_rad) angle = kStep_rad * std::round(angle / kStep_rad);
  return record;
}

Diagnosis diagnosed(const Record& record, const WheelArm& wheel, std::vector<std::string> without = {}) {
  DiagnoseOptions options;
  options.figures = false;
  options.bootstrap_draws = 20;
  options.without = std::move(without);
  return diagnose(record, test::off_by_five_percent(wheel), options);
}

TEST(RoundingSpectrum, LeavesAnEffectBesideACoarseAngleTheLikeliestAndInventsNone) {
  test::DrawnDrive what;
  const Diagnosis plain = diagnosed(coarse_drive(what, test::seed(93)), what.wheel);
  ASSERT_EQ(plain.causes.size(), 1U);
  EXPECT_EQ(plain.causes[0].effect.type, &effect::coarse_quantization);
  what.torque = [](double, double angle, double) { return -800 * angle * angle * angle; };
  const Diagnosis bent = diagnosed(coarse_drive(what, test::seed(93)), what.wheel);
  EXPECT_EQ(test::likeliest_changes(bent), std::vector<std::string>{"cubic_stiffness"});
}

TEST(RoundingSpectrum, WithoutItsNameACoarseAngleIsNoEffectOnTheWheel) {
  const test::DrawnDrive what;
  const Diagnosis diagnosis = diagnosed(coarse_drive(what, test::seed(94)), what.wheel, {"coarse_quantization"});
  EXPECT_TRUE(diagnosis.verdict == "unknown" || diagnosis.verdict == "parameters") << diagnosis.verdict;
}

}  // namespace
}  // namespace steerid::gap
