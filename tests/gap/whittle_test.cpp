// The likelihood on Fourier lines: at the truth it stands at the floor, and its fits are as good as they say.
#include "gap/whittle.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

#include "gap/drawn_drive.hpp"
#include "gap/spectral_search.hpp"
#include "plant/effects/vocabulary.hpp"
#include "sensors/random.hpp"
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
  const BlockSpectra spectra(held_out_split(record, 100), 100);
  NothingApplied model(spectra.of(record.angle_rad), kStiffness);
  NoiseFloor white;
  white.angle_variance = kNoise * kNoise;
  const Whittle whittle(spectra, white, kTorque / 0.02);
  const Whittle::Fit judged = whittle.judge(model, Eigen::VectorXd::Zero(3), {}, kAll, SlowTorque::kFloor);
  // 1,200 lines: 3 %; lines that leak into each other and a colour that is none of those tried: more. The noise is 300
  // times below the torque; without the trends it is 16.
  EXPECT_NEAR(judged.excess(kAll), 1.0, 0.25);
  // A size in steps of a fifth, of a colour that is none of those tried.
  EXPECT_NEAR(std::sqrt(judged.floor.slow_variance), kTorque, 0.5 * kTorque);
}

}  // namespace
}  // namespace steerid
