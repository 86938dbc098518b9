// The likelihood on Fourier lines: at the truth it stands at the floor, and its fits are as good as they say.
#include "gap/whittle.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "gap/drawn_drive.hpp"
#include "gap/spectral_search.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

const Whittle::Roles kAll = {Block::Role::kFit, Block::Role::kChoose, Block::Role::kReport};

TEST(Whittle, StandsAtTheFloorForTheTrueWheelAndFindsIt) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(31));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record, 100), 100, false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel, 100), spectral.applied_rms_nm);
  SpectralModel model(spectral, {});
  const auto fitted = fitted_parameters(what.wheel, what.wheel, {});
  Eigen::VectorXd start(3);
  start << 0.13, 1.1, 26;
  const Whittle::Fit fit = whittle.fit(model, start, fitted, kAll, SlowTorque::kFloor, 300);
  // 680 complex lines: the mean of as many exponential variables has an sd of 4 %; the levels are known to 4 % too.
  EXPECT_NEAR(fit.excess(kAll), 1.0, 0.15);
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
  const SpectralRecord spectral(record, what.wheel, held_out_split(record, 100), 100, false);
  const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel, 100), spectral.applied_rms_nm);
  SpectralModel linear(spectral, {});
  const auto fitted = fitted_parameters(what.wheel, what.wheel, {});
  Eigen::VectorXd start(3);
  start << 0.11, 1.5, 22.7;
  const Whittle::Fit refit = whittle.fit(linear, start, fitted, kAll, SlowTorque::kFloor, 300);
  EXPECT_GT(refit.excess(kAll), 2);
  const std::vector<SearchOrigin> origins = {{LinearScan(spectral, whittle, {}, refit, kAll), refit.x}};
  for (const auto& hypothesis : hypotheses()) {
    if (&hypothesis->type() != &effect::delay) continue;
    const Whittle::Fit fit = search(*hypothesis, {spectral, whittle, origins, {}, what.wheel, what.wheel, kAll});
    EXPECT_NEAR(fit.x[3], 0.012, 0.0003);
    EXPECT_NEAR(fit.excess(kAll), 1.0, 0.15);
  }
}

}  // namespace
}  // namespace steerid
