// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What speaks for `unknown` where the right effect is not in the library: drives made by a route of their own
// (gap/drawn_drive.hpp), diagnosed with and without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/verdict_ids.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/hypotheses/hypotheses.hpp"
#include "gap/likelihood/held_out_split.hpp"
#include "gap/model/straightened_model.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

std::string verdict(test::DrawnDrive what, std::uint64_t seed, std::vector<std::string> without) {
  what.duration_s = 80;
  DiagnoseOptions options;
  options.without = std::move(without);
  options.figures = false;
  return diagnose(test::drive(what, test::seed(seed)), test::off_by_five_percent(what.wheel), options).verdict;
}

/// In the value of a bias the model is straight already: a torque that stands beside it is that bias, and nothing else.
TEST(StraightenedModel, IsTheModelWhereThatIsStraight) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(69));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record), false);
  const Parts bias = {hypothesis_of(effect::torque_bias)};
  SpectralModel model(spectral, bias);
  Eigen::VectorXd x(4);
  x << 0.11, 1.5, 22.7, 0.0;
  const std::vector<Fitted> fitted = fitted_parameters(what.wheel, bias);
  StraightenedModel straight(model, x, fitted, differences(model, x, fitted));
  straight.stand_beside({spectral.spectra.of(std::vector<double>(record.size(), 1.0))});
  Spectrum expected;
  Spectrum along_bias;
  Spectrum beside;
  Response response;
  Eigen::VectorXd at = straight.start();
  ASSERT_EQ(at.size(), 5);
  x[3] = at[3] = 0.7;
  model.evaluate(x, expected, response);
  straight.evaluate(at, along_bias, response);
  EXPECT_LT((along_bias - expected).norm(), 1e-6 * expected.norm());
  at[3] = 0;
  at[4] = 1;
  straight.evaluate(at, beside, response);
  const Spectrum by_bias = expected - straight.residual();
  const Spectrum by_torque = beside - straight.residual();
  EXPECT_NEAR(std::abs(by_bias.dot(by_torque)), by_bias.norm() * by_torque.norm(),
              1e-6 * by_bias.norm() * by_torque.norm());
  EXPECT_NEAR(by_torque.norm(), straight.residual().norm(), 1e-9 * by_torque.norm());
}

/// Noise that stands in a shape is in what is left, too, and with the wrong sign the one explains the other: of an
/// angle of 1.3 mrad beside a drag that takes twice what the damping takes, and of a loud torque beside a quiet angle.
TEST(Rivals, NoiseDoesNotExplainItself) {
  test::DrawnDrive drags;
  drags.wheel = {0.066, 2.4, 20.5};
  drags.angle_noise_rad = 0.0013;
  drags.torque = [](double t, double, double rate) { return -17 * std::abs(rate) * rate + test::unseen_nm(t) / 3; };
  EXPECT_EQ(verdict(drags, 93, {}), "quadratic_damping");
  test::DrawnDrive shakes;
  shakes.wheel = {0.04, 0.5, 54};
  shakes.angle_noise_rad = 0.0001;
  shakes.torque_noise_nm = 0.045;
  shakes.probe_rms_nm = 1.2;
  shakes.torque = [](double t, double, double) { return 0.8 * std::sin(5.9 * t); };
  EXPECT_EQ(verdict(shakes, 94, {}), "periodic_disturbance");
}

/// A torque that creeps by 0.25 Nm beside one that nobody sees. A larger slow torque would hold all of it but the mean,
/// so that only a trend to which the slow torque gives it back can tell.
TEST(Rivals, ATrendIsToldFromASlowTorqueThatHasGrownToHoldIt) {
  test::DrawnDrive creeps;
  creeps.torque = [](double t, double, double) { return 0.1 + 0.003 * t + test::unseen_nm(t); };
  EXPECT_EQ(verdict(creeps, 66, {}), "torque_drift");
  EXPECT_FALSE(names_effect(verdict(creeps, 66, {"torque_drift"})));
}

TEST(Rivals, ATorqueThatStaysIsABiasWithoutTheLibrarysDrift) {
  test::DrawnDrive stays;
  stays.torque = [](double t, double, double) { return 0.25 + test::unseen_nm(t); };
  EXPECT_EQ(verdict(stays, 67, {"torque_drift"}), "torque_bias");
}

/// A delay of 30 ms is a lag but for what grows with the square of frequency.
TEST(Rivals, ADelayIsNoLagWhereTheLibraryHasBoth) {
  test::DrawnDrive late;
  late.delay_s = 0.03;
  EXPECT_EQ(verdict(late, 68, {}), "delay");
}

}  // namespace
}  // namespace steerid::gap
