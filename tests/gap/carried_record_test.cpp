// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The motion that a simulation's own run carries, against the wheel's true motion: that of the same drive without the
// noise of its angle (gap/drawn_drive.hpp).
#include "gap/model/carried_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/drawn_drive.hpp"
#include "gap/hypotheses/hypotheses.hpp"
#include "gap/model/point.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// A spring that is several times as stiff at the ends of the movement as in its middle, and a torque that no sensor
/// sees.
class StrongSpring : public ::testing::Test {
 protected:
  static test::DrawnDrive what(double angle_noise_rad) {
    test::DrawnDrive drive;
    drive.angle_noise_rad = angle_noise_rad;
    drive.torque = [](double t, double x, double) { return -kCubic * x * x * x + test::unseen_nm(t); };
    return drive;
  }

  static constexpr double kCubic = 3000;
  static constexpr double kNoise_rad = 0.0002;
  const test::DrawnDrive drive_ = what(kNoise_rad);
  const std::uint64_t seed_ = test::seed(81);
  const Record record_ = test::drive(drive_, seed_);
  /// Its motion is carried by the run of the plain wheel.
  const SpectralRecord plain_{record_, drive_.wheel, held_out_split(record_), false};
  static Point with_spring(const WheelArm& wheel, double cubic) {
    Point at{wheel, {Effect(effect::cubic_stiffness)}};
    at.effects.front().values = {cubic};
    return at;
  }
  const Point truth_ = with_spring(drive_.wheel, kCubic);
  SimulatedModel model_{plain_, hypotheses_of(truth_.effects)};
};

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 20; i + 20 < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size() - 40));
}

TEST_F(StrongSpring, CarriesTheMotionToWithinTheSmoothedNoise) {
  const SpectralRecord carried = carried_record(plain_, model_, truth_);
  const std::vector<double> true_rad = test::drive(what(0), seed_).angle_rad;
  // White noise through a Gaussian of 10 Hz at -3 dB: sqrt(pi/ln 2) 10/100 = 0.21 of its power is left, 0.46 of its
  // size; half as much again for what the unseen torque moves above the smoothing.
  const double error_rad = rms_difference(carried.motion.angle_rad, true_rad);
  EXPECT_GT(error_rad, 0.9 * 0.46 * kNoise_rad);
  EXPECT_LT(error_rad, 1.5 * 0.46 * kNoise_rad);
  EXPECT_GT(rms_difference(plain_.motion.angle_rad, true_rad), 3 * error_rad);
  std::vector<double> true_rate(true_rad.size(), 0.0);
  for (std::size_t i = 2; i + 2 < true_rad.size(); ++i) {
    true_rate[i] = 100 * (8 * (true_rad[i + 1] - true_rad[i - 1]) - (true_rad[i + 2] - true_rad[i - 2])) / 12;
  }
  EXPECT_GT(rms_difference(plain_.motion.rate_rad_s, true_rate),
            3 * rms_difference(carried.motion.rate_rad_s, true_rate));
}

TEST_F(StrongSpring, ReachesTheFloorOnIt) {
  const Whittle whittle(plain_.spectra, NoiseFloor::of(record_, drive_.wheel, 50), plain_.applied_rms_nm);
  const std::vector<Fitted> fitted = fitted_parameters(drive_.wheel, hypotheses_of(truth_.effects));
  const auto excess = [&](ResidualModel& model) {
    return whittle.judge(model, truth_.numbers(), fitted, kSeen, SlowTorque::kFloor).excess(kSeen);
  };
  const SpectralRecord carried = carried_record(plain_, model_, truth_);
  SpectralModel on_carried(carried, hypotheses_of(truth_.effects));
  SpectralModel on_plain(plain_, hypotheses_of(truth_.effects));
  // Some 500 lines: the floor's own excess is 1 within 0.1 (twice 1/sqrt(500)).
  EXPECT_NEAR(excess(on_carried), 1, 0.15);
  EXPECT_GT(excess(on_plain), 1.5);
  EXPECT_GT(excess(model_), 1.5);  // of its run the unseen torque is missing
}

TEST_F(StrongSpring, StaysAsItWasWhereTheRunDiverges) {
  WheelArm wild = drive_.wheel;
  wild.stiffness_nm_per_rad = -50;
  const SpectralRecord carried = carried_record(plain_, model_, with_spring(wild, -5000));
  EXPECT_EQ(carried.motion.angle_rad, plain_.motion.angle_rad);
  EXPECT_EQ(carried.motion.rate_rad_s, plain_.motion.rate_rad_s);
}

}  // namespace
}  // namespace steerid::gap
