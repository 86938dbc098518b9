// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The likelihood on Fourier lines: at the truth it stands at the floor, and its fits are as good as they say.
#include "gap/likelihood/whittle.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "gap/compared_drive.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/sets/spectral_search.hpp"
#include "plant/effects/vocabulary.hpp"
#include "sensors/random.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

TEST(Whittle, StandsAtTheFloorForTheTrueWheelAndFindsIt) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(31));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record), false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel), spectral.applied_rms_nm);
  SpectralModel model(spectral, {});
  const auto fitted = fitted_parameters(what.wheel, {});
  Eigen::VectorXd start(3);
  start << 0.13, 1.1, 26;
  const Whittle::Fit fit = whittle.fit(model, start, fitted, kAllRoles, SlowTorque::kFloor, 300);
  // 680 complex lines: the mean of as many exponential variables has an sd of 4 %; the levels are known to 4 % too.
  EXPECT_NEAR(fit.excess(kAllRoles), 1.0, 0.15);
  const Eigen::MatrixXd covariance = fit.information.inverse();
  const double truth[] = {0.11, 1.5, 22.7};
  for (int i = 0; i < 3; ++i) {
    const double sd = std::sqrt(covariance(i, i));
    EXPECT_LT(std::abs(fit.x[i] - truth[i]), 4 * sd) << i;  // one in 16,000
    EXPECT_LT(sd, 0.005 * truth[i]) << i;
  }
}

TEST(Whittle, ADelayIsFoundAndAWheelWithoutItIsFarFromTheFloor) {
  test::DrawnDrive what;
  what.delay_s = 0.012;
  const Record record = test::drive(what, test::seed(32));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record), false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel), spectral.applied_rms_nm);
  SpectralModel linear(spectral, {});
  const auto fitted = fitted_parameters(what.wheel, {});
  Eigen::VectorXd start(3);
  start << 0.11, 1.5, 22.7;
  const Whittle::Fit refit = whittle.fit(linear, start, fitted, kAllRoles, SlowTorque::kFloor, 300);
  EXPECT_GT(refit.excess(kAllRoles), 2);
  const std::vector<Spectrum> slopes = differences(linear, refit.x, fitted);
  const SearchOrigin origin{LinearScan(spectral, {}, refit, kAllRoles, {}, slopes), Point::of(refit.x, {}), record,
                            slopes};
  for (const auto& hypothesis : hypotheses()) {
    if (&hypothesis->type() != &effect::delay) continue;
    const Whittle::Fit fit = search(
        *hypothesis, {spectral, whittle, starting_points(*hypothesis, spectral, origin), {}, what.wheel, kAllRoles});
    EXPECT_NEAR(fit.x[3], 0.012, 0.0003);
    EXPECT_NEAR(fit.excess(kAllRoles), 1.0, 0.15);
  }
}

NoiseFloor white_floor() {
  NoiseFloor floor;
  floor.angle_variance = 1e-7;
  floor.torque_variance = 1e-4;
  return floor;
}

Response response_of(const WheelArm& wheel, const BlockSpectra& spectra) {
  Response response;
  response.gain.resize(spectra.bins());
  for (Eigen::Index k = 0; k < spectra.bins(); ++k) response.gain[k] = wheel_response(wheel, spectra.omega()[k]);
  response.ends = response.gain;
  return response;
}

/// Whatever a block begins and ends with: a polynomial in i w behind the poles, real coefficients.
TEST(Whittle, WhatABlocksEndsLeakIsGoneAndHardlyAnythingElse) {
  const test::DrawnDrive what;
  const std::uint64_t seed = test::seed(34);
  const Record record = test::drive(what, seed);
  const BlockSpectra spectra(held_out_split(record));
  NoiseFloor floor = white_floor();
  const Response response = response_of(what.wheel, spectra);
  const Whittle::Whitened whitened(spectra, response, floor, kAllRoles);
  Random random(seed, 2);
  Spectrum leaked = Spectrum::Zero(spectra.bins());
  Spectrum noise(spectra.bins());
  double expected = 0;
  for (const BlockSpectra::Bins& bins : spectra.blocks()) {
    std::array<double, kEnds> coefficient{};
    for (double& one : coefficient) one = random.normal();
    for (Eigen::Index k = bins.first; k < bins.first + bins.count; ++k) {
      const std::complex<double> s(0, spectra.omega()[k] / (2 * std::numbers::pi * kHighest_hz));
      for (int power = 0; power < kEnds; ++power) {
        leaked[k] += response.ends[k] * coefficient[static_cast<std::size_t>(power)] * std::pow(s, power);
      }
      const double sd = std::sqrt((1e-7 + std::norm(response.gain[k]) * 1e-4) / 2);
      noise[k] = {sd * random.normal(), k == bins.first ? 0 : sd * random.normal()};
      if (k == bins.first) noise[k] *= std::numbers::sqrt2;  // real, of the same power
    }
    expected += static_cast<double>(bins.count) - 0.5 - kEnds / 2.0;
  }
  EXPECT_LT(whitened(leaked).norm() / leaked.norm(), 1e-9 * whitened(noise).norm() / noise.norm());
  // As many half degrees of freedom as are left: a sum of exponential variables, four standard deviations.
  EXPECT_NEAR(whitened(noise).squaredNorm(), expected, 4 * std::sqrt(expected));
  EXPECT_EQ(whitened.lines(), expected);
}

/// A driver's steering just below the lowest line that is compared, which the filter's flank lets pass: a sinusoid that
/// does not end where a block does.
TEST(Whittle, WhatLeaksFromBelowTheLowestLineIsGone) {
  constexpr double kLowest_hz = 2;
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(36));
  const BlockSpectra spectra(held_out_split(record), kHighest_hz, kLowest_hz);
  EXPECT_NEAR(spectra.omega().minCoeff() / (2 * std::numbers::pi), kLowest_hz, 0.25);
  EXPECT_GE(spectra.omega().minCoeff() / (2 * std::numbers::pi), kLowest_hz);
  NoiseFloor floor = white_floor();
  const Response response = response_of(what.wheel, spectra);
  const Whittle::Whitened as_it_is(spectra, response, floor, kAllRoles);
  floor.lowest_hz = kLowest_hz;
  floor.steering_tail_nm = 0.01;
  const Whittle::Whitened without_leaks(spectra, response, floor, kAllRoles);
  EXPECT_EQ(as_it_is.lines() - without_leaks.lines(), static_cast<double>(spectra.blocks().size()));
  for (const double f_hz : {1.71, 1.75, 1.79}) {  // no whole number of turns in a block
    std::vector<double> steered(record.size());
    for (std::size_t i = 0; i < steered.size(); ++i) {
      steered[i] = 0.01 * std::sin(2 * std::numbers::pi * f_hz * static_cast<double>(i) / 100 + 0.7);
    }
    const Spectrum leaked = spectra.of(steered);
    EXPECT_LT(without_leaks(leaked).norm(), 0.1 * as_it_is(leaked).norm()) << f_hz;
  }
}

TEST(Whittle, WhatIsJudgedOfARoleIsWhatItsBlocksAloneSay) {
  const test::ComparedDrive compared({}, test::seed(35));
  SpectralModel model(compared.spectral, {});
  Eigen::VectorXd x(3);
  x << 0.12, 1.4, 24;
  const Whittle::Fit judged = compared.judged(model, x, {}, kSeen);
  Spectrum residual;
  Response response;
  model.evaluate(x, residual, response);
  for (const Block::Role role : kAllRoles) {
    const Whittle::Whitened whitened(compared.spectral.spectra, response, judged.floor, {role});
    const double chi = whitened(residual).squaredNorm();
    const Misfit& misfit = judged.misfit[static_cast<std::size_t>(role)];
    EXPECT_NEAR(misfit.chi, chi, 1e-9 * chi);
    EXPECT_NEAR(misfit.cost, chi + whitened.sum_log_density(), 1e-9 * chi);
    EXPECT_EQ(misfit.lines, whitened.lines());
    EXPECT_GT(misfit.lines, 100);
  }
}

/// A model that predicts nothing of a static wheel: the residual is what was measured.
class NothingApplied final : public ResidualModel {
 public:
  NothingApplied(Spectrum angle, double stiffness) : angle_(std::move(angle)), stiffness_(stiffness) {}
  void evaluate(const Eigen::VectorXd&, Spectrum& residual, Response& response) override {
    residual = angle_;
    response.gain = Spectrum::Constant(angle_.size(), 1 / stiffness_);
    response.ends = response.gain;
  }

 private:
  Spectrum angle_;
  double stiffness_;
};

/// A slow torque goes on beyond a block: it leaks into lines far above its own band, 400 times the noise here at 1.5
/// Hz. The torque is a sum of tones below 0.95 Hz whose power falls as that of first-order noise.
TEST(Whittle, ASlowTorqueThatIsCutOffByABlockIsNoExcess) {
  constexpr double kStiffness = 20;
  constexpr double kTorque = 0.1;
  constexpr double kNoise = 2e-5;
  Random random(test::seed(33), 1);
  Record record;
  std::array<double, 60> amplitude{};
  std::array<double, 60> phase{};
  double power = 0;
  for (std::size_t i = 0; i < amplitude.size(); ++i) {
    const double f = 0.95 * (static_cast<double>(i) + 0.5) / 60;
    amplitude[i] = std::hypot(random.normal(), random.normal()) / std::hypot(1.0, f / 0.2);
    phase[i] = 2 * std::numbers::pi * random.uniform();
    power += amplitude[i] * amplitude[i] / 2;
  }
  for (int n = 0; n < 10'000; ++n) {
    double torque = 0;
    for (std::size_t i = 0; i < amplitude.size(); ++i) {
      const double f = 0.95 * (static_cast<double>(i) + 0.5) / 60;
      torque += amplitude[i] * std::cos(2 * std::numbers::pi * f * 0.01 * n + phase[i]);
    }
    record.time_s.push_back(0.01 * n);
    record.angle_rad.push_back(kTorque * torque / std::sqrt(power) / kStiffness + kNoise * random.normal());
  }
  const BlockSpectra spectra(held_out_split(record));
  NothingApplied model(spectra.of(record.angle_rad), kStiffness);
  NoiseFloor white;
  white.angle_variance = kNoise * kNoise;
  const Whittle whittle(spectra, white, kTorque / 0.02);
  const Whittle::Fit judged = whittle.judge(model, Eigen::VectorXd::Zero(3), {}, kAllRoles, SlowTorque::kFloor);
  // 1,200 lines: 3 %; lines that leak into each other and a colour that is none of those tried: more. The noise is 300
  // times below the torque; without the trends it is 16.
  EXPECT_NEAR(judged.excess(kAllRoles), 1.0, 0.25);
  // A size in steps of a fifth, of a colour that is none of those tried.
  EXPECT_NEAR(std::sqrt(judged.floor.slow_variance), kTorque, 0.5 * kTorque);
}

/// Half sines of 0.3 s, a torque that no record knows, of sizes drawn from a normal distribution, on a wheel without
/// inertia: 20 times the noise's power where they are, and no excess where they are known to be unknown.
TEST(Whittle, WhatAClippedTorqueHidIsNoExcess) {
  constexpr double kStiffness = 20;
  constexpr double kTorque = 0.4;
  constexpr double kNoise = 2e-3;
  constexpr std::size_t kLength = 30;
  Random random(test::seed(34), 1);
  Eigen::MatrixXd shape(kLength, 1);
  for (std::size_t i = 0; i < kLength; ++i) {
    shape(static_cast<Eigen::Index>(i), 0) = kTorque * std::sin(std::numbers::pi * (static_cast<double>(i) + 1) / 31);
  }
  Record record;
  for (int n = 0; n < 10'000; ++n) {
    record.time_s.push_back(0.01 * n);
    record.angle_rad.push_back(kNoise * random.normal());
  }
  BlockSpectra known(held_out_split(record));
  BlockSpectra unknown = known;
  for (std::size_t first = 50; first + kLength < record.size(); first += 200) {
    const double size = random.normal();
    for (std::size_t i = 0; i < kLength; ++i) {
      record.angle_rad[first + i] += size * shape(static_cast<Eigen::Index>(i), 0) / kStiffness;
    }
    unknown.hide(first, shape, false);
  }
  NoiseFloor white;
  white.angle_variance = kNoise * kNoise;
  const auto excess = [&](const BlockSpectra& spectra) {
    NothingApplied model(spectra.of(record.angle_rad), kStiffness);
    const Whittle whittle(spectra, white, kTorque);
    return whittle.judge(model, Eigen::VectorXd::Zero(3), {}, kAllRoles, SlowTorque::kFloor).excess(kAllRoles);
  };
  EXPECT_GT(excess(known), 3);
  // 1,200 lines: 3 %; of the slow torque that a fit adds to any noise, some percent less than one.
  EXPECT_NEAR(excess(unknown), 1.0, 0.12);
  // Lines that count for nothing leave nothing to be unknown; equal ones leave all of it.
  BlockSpectra condensed = unknown;
  condensed.condense_hidden(Eigen::VectorXd::Constant(condensed.bins(), 1 / kStiffness / kNoise), 1e-3);
  EXPECT_NEAR(excess(condensed), excess(unknown), 1e-3);
  condensed.condense_hidden(Eigen::VectorXd::Zero(condensed.bins()), 1e-3);
  EXPECT_NEAR(excess(condensed), excess(known), 1e-9);
}

}  // namespace
}  // namespace steerid::gap
