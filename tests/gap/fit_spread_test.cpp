// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Intervals of fitted numbers: how often they hold the truth, on drives of an independent integrator.
#include "gap/likelihood/fit_spread.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <numbers>

#include "gap/drawn_drive.hpp"
#include "gap/likelihood/student.hpp"
#include "gap/model/spectral_model.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

TEST(Student, HasTheQuantilesOfTheTables) {
  EXPECT_NEAR(student95(5), 2.571, 0.005 * 2.571);
  EXPECT_NEAR(student95(9), 2.262, 0.002 * 2.262);
  EXPECT_NEAR(student95(1e6), 1.960, 0.001);
}

struct Coverage {
  int held = 0;    ///< of three numbers a drive
  int narrow = 0;  ///< by the information matrix and the excess alone
  int all = 0;
};

constexpr WheelArm kTrue{0.11, 1.5, 22.7};

/// A linear wheel in its steady state, in closed form: tones of the motor, and tones of a torque that no sensor sees
/// within a band around 3 Hz.
Record drive(double unseen_nm, std::uint64_t seed) {
  constexpr int kTones = 60;
  constexpr int kUnseen = 12;
  constexpr double kMotor_nm = 0.33;
  test::Noise noise(seed);
  struct Tone {
    double w, phase, motor_nm;
    std::complex<double> moves;
  };
  std::vector<Tone> tones;
  for (int k = 0; k < kTones + kUnseen; ++k) {
    const bool seen = k < kTones;
    const double f = seen ? 0.15 + 0.0871 * k : 2.7 + 0.0531 * (k - kTones);
    const double w = 2 * std::numbers::pi * f;
    const double size = seen ? kMotor_nm : unseen_nm / std::sqrt(kUnseen / 2.0);
    const std::complex<double> response = 1.0 / std::complex<double>(22.7 - 0.11 * w * w, 1.5 * w);
    tones.push_back({w, 2 * std::numbers::pi * noise.uniform(), seen ? size : 0, -size * response});
  }
  Record record;
  for (int i = 0; i < 6000; ++i) {
    const double t = i / 100.0;
    double motor = 0;
    double angle = 0;
    for (const Tone& tone : tones) {
      const std::complex<double> turned = std::polar(1.0, tone.w * t + tone.phase);
      motor += tone.motor_nm * turned.real();
      angle += (tone.moves * turned).real();
    }
    record.time_s.push_back(t);
    record.torque_motor_nm.push_back(motor);
    record.torque_driver_nm.push_back(0.02 * noise());
    record.angle_rad.push_back(angle + 0.0006 * noise());
  }
  return record;
}

Coverage coverage(int drives, double unseen_nm, std::uint64_t seed) {
  Coverage out;
  for (int i = 0; i < drives; ++i) {
    const Record record = drive(unseen_nm, seed + static_cast<std::uint64_t>(i));
    const SpectralRecord spectral(record, kTrue, held_out_split(record), false);
    const Whittle whittle(spectral.spectra, NoiseFloor::of(record, kTrue), spectral.applied_rms_nm);
    SpectralModel model(spectral, {});
    const auto fitted = fitted_parameters(kTrue, {});
    Eigen::VectorXd start(3);
    start << 0.11, 1.5, 22.7;
    const Whittle::Fit fit = whittle.fit(model, start, fitted, kAllRoles, SlowTorque::kFloor, 60);
    const FitSpread spread = spread_of(whittle, model, fit, fitted, kAllRoles);
    const Eigen::MatrixXd covariance = fit.information.inverse() * std::max(1.0, fit.excess(kAllRoles));
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double sd = std::sqrt(covariance(k, k));
      EXPECT_GE(spread.high[k] - fit.x[k], 1.6 * sd);  // the floor is anew since that information
      EXPECT_LE(spread.high[k] - fit.x[k], 30 * sd);   // nor without bounds
      out.held += spread.low[k] <= start[k] && start[k] <= spread.high[k] ? 1 : 0;
      out.narrow += std::abs(fit.x[k] - start[k]) <= kNormal95 * sd ? 1 : 0;
      ++out.all;
    }
  }
  return out;
}

/// 95 % of 90 numbers are 85.5; three of a drive go together, so that the sd is up to 3.6. 76 is 2.6 of these below;
/// the largest of three estimates holds more than it promises, so nothing is too many.
TEST(FitSpread, HoldsTheTruthUnderWhiteNoise) {
  const Coverage found = coverage(30, 0, test::seed(81));
  EXPECT_GE(found.held, 76) << "of " << found.all;
}

/// A torque within a band of its own: the information matrix spreads the excess over all lines and holds too little, by
/// far; the groups hold what they should. 95 % of 90 as above.
TEST(FitSpread, HoldsTheTruthUnderAMisfitOfItsOwnColour) {
  const Coverage found = coverage(30, 0.25, test::seed(82));
  EXPECT_GE(found.held, 76) << "of " << found.all << ", by the information " << found.narrow;
  EXPECT_LE(found.narrow, 76) << "of " << found.all;
}

}  // namespace
}  // namespace steerid::gap
