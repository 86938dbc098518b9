// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Is the batch fit as good as it can be, and does it know how good it is? Hundreds of seeded records against the
// Cramer-Rao bound, which is computed here, in the frequency domain, from the true spectra.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "fit/gauss_newton.hpp"
#include "plant/linear_response.hpp"
#include "support/seed.hpp"

namespace {

using steerid::Record;
using steerid::TorqueSignal;
using steerid::WheelArm;
using Complex = std::complex<double>;

constexpr double kPi = std::numbers::pi;
constexpr double kRate_hz = 100;
constexpr std::size_t kSamples = 3000;  // 30 s
constexpr double kTorqueRms_nm = 1.5;
constexpr int kLines = 24;  // 0.2 Hz to 4.8 Hz, whole periods in the record
constexpr double kTorqueNoise_nm = 0.03;

struct Noise {
  const char* what;
  double angle_deg;
  double disturbance_share;  // of the applied torque's rms
  int low_passes = 2;        // behind which the disturbance lies
  double corner_hz = 0.4;    // of theirs
};

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }
  double normal() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * kPi * uniform()); }

 private:
  std::mt19937_64 engine_;
};

// The unmeasured torque: white noise through 1/(1 + s/w) or 1/(1 + s/w)^2, sampled as a chain of discrete first-order
// lags; its gain and its rms are known in closed form.
struct Lags {
  explicit Lags(const Noise& noise) : a(std::exp(-2 * kPi * noise.corner_hz / kRate_hz)), n(noise.low_passes) {}
  double a;
  int n;
  [[nodiscard]] double power_gain(double f) const {
    return std::pow(std::norm((1 - a) / (1.0 - a * std::polar(1.0, -2 * kPi * f / kRate_hz))), n);
  }
  // variance of the output for unit white input: sum of ((1-a) a^k)^2, or of ((1-a)^2 (k+1) a^k)^2
  [[nodiscard]] double variance() const {
    return n == 1 ? (1 - a) / (1 + a) : std::pow(1 - a, 4) * (1 + a * a) / std::pow(1 - a * a, 3);
  }
};

double true_torque(double t, const std::vector<double>& phase) {
  double sum = 0;
  for (int k = 1; k <= kLines; ++k) sum += std::sin(2 * kPi * 0.2 * k * t + phase[static_cast<std::size_t>(k - 1)]);
  return kTorqueRms_nm * std::sqrt(2.0 / kLines) * sum;
}

Record drive(const WheelArm& wheel, const Noise& noise, Random& random) {
  std::vector<double> phase;
  for (int k = 0; k < kLines; ++k) phase.push_back(2 * kPi * random.uniform());
  const Lags lag(noise);
  const double disturbance = noise.disturbance_share * kTorqueRms_nm / std::sqrt(lag.variance());
  double lag1 = 0;
  double lag2 = 0;
  constexpr std::size_t kWarmUp = 1000;  // ten seconds: neither wheel nor disturbance starts from rest
  std::vector<double> t;
  std::vector<double> applied;
  std::vector<double> measured;
  for (std::size_t i = 0; i < kSamples + kWarmUp; ++i) {
    t.push_back(static_cast<double>(i) / kRate_hz);
    lag1 = lag.a * lag1 + (1 - lag.a) * random.normal();
    lag2 = lag.a * lag2 + (1 - lag.a) * lag1;
    const double torque = true_torque(t.back(), phase);
    measured.push_back(torque + kTorqueNoise_nm * random.normal());
    applied.push_back(torque + disturbance * (lag.n == 1 ? lag1 : lag2));
  }
  const std::vector<double> angle =
      steerid::free_run(wheel, TorqueSignal::from_samples(t, applied, TorqueSignal::Between::kBandLimited), t, {});
  Record record;
  for (std::size_t i = kWarmUp; i < t.size(); ++i) {
    record.time_s.push_back(t[i]);
    record.torque_driver_nm.push_back(measured[i]);
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(angle[i] + noise.angle_deg * kPi / 180 * random.normal());
  }
  return record;
}

// Cramer-Rao standard deviations of J, B, C: Fisher information summed over the lines of the torque, each line's
// derivative dG T against the residual's spectrum S = S_theta + |G|^2 (S_torque + S_disturbance). Spectra per sample
// (a white one is its variance).
Eigen::Vector3d cramer_rao(const WheelArm& wheel, const Noise& noise) {
  const Lags lag(noise);
  const double disturbance = std::pow(noise.disturbance_share * kTorqueRms_nm, 2) / lag.variance();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (int k = 1; k <= kLines; ++k) {
    const double f = 0.2 * k;
    const Complex s(0, 2 * kPi * f);
    const Complex gain =
        1.0 / (wheel.inertia_kgm2 * s * s + wheel.damping_nms_per_rad * s + wheel.stiffness_nm_per_rad);
    const double spectrum = std::pow(noise.angle_deg * kPi / 180, 2) +
                            std::norm(gain) * (kTorqueNoise_nm * kTorqueNoise_nm + disturbance * lag.power_gain(f));
    const Complex common = -gain * gain * kTorqueRms_nm * std::sqrt(2.0 / kLines);
    const Complex derivative[] = {common * s * s, common * s, common};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        information(i, j) +=
            static_cast<double>(kSamples) / 2 * (derivative[i] * std::conj(derivative[j])).real() / spectrum;
      }
    }
  }
  return information.inverse().diagonal().cwiseSqrt();
}

const WheelArm kWheels[] = {{0.06, 0.4, 2.0}, {0.11, 1.5, 22.7}, {0.11, 2.1, 45.9}};

struct Tally {
  Eigen::Vector3d square = Eigen::Vector3d::Zero();  // of error / bound
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();     // of error / value
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  double nees = 0;  // sum of e' P^-1 e
  int records = 0;
};

Tally run(const WheelArm& wheel, const Noise& noise, int records, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Vector3d truth(wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad);
  const Eigen::Vector3d bound = cramer_rao(wheel, noise);
  Tally tally;
  steerid::FitOptions options;
  options.convergence_factor = false;
  for (int i = 0; i < records; ++i) {
    const steerid::BatchFit fit = steerid::fit_batch(drive(wheel, noise, random), options);
    EXPECT_EQ(fit.stop, steerid::StopReason::kGradient);
    const steerid::FittedParameter* const found[] = {&fit.inertia, &fit.damping, &fit.stiffness};
    for (int k = 0; k < 3; ++k) {
      const double error = found[k]->value - truth[k];
      tally.square[k] += std::pow(error / bound[k], 2);
      tally.sum[k] += error / truth[k];
      tally.inside[k] += std::abs(error) <= 1.959964 * found[k]->sd ? 1 : 0;
    }
    const Eigen::Vector3d error = Eigen::Vector3d(fit.inertia.value, fit.damping.value, fit.stiffness.value) - truth;
    tally.nees += error.dot(Eigen::Matrix3d(fit.covariance.topLeftCorner<3, 3>()).inverse() * error);
    ++tally.records;
  }
  return tally;
}

class MonteCarlo : public ::testing::TestWithParam<Noise> {};

TEST_P(MonteCarlo, ReachesTheCramerRaoBoundAndKnowsItsError) {
  const Noise noise = GetParam();
  constexpr int kRecords = 200;
  Tally all;
  std::uint64_t seed = steerid::test::seed(20180131);
  for (const WheelArm& wheel : kWheels) {
    const Tally one = run(wheel, noise, kRecords, seed++);
    const Eigen::Vector3d ratio = (one.square / one.records).cwiseSqrt();
    const Eigen::Vector3d bias = one.sum / one.records;
    const Eigen::Vector3d cover = one.inside / one.records;
    const Eigen::Vector3d bound = cramer_rao(wheel, noise);
    std::printf(
        "%-28s C=%-5g rmse/bound %.3f %.3f %.3f  bias %+.2e %+.2e %+.2e  95%% covers %.3f %.3f %.3f  bound %.2e %.2e "
        "%.2e\n",
        noise.what, wheel.stiffness_nm_per_rad, ratio[0], ratio[1], ratio[2], bias[0], bias[1], bias[2], cover[0],
        cover[1], cover[2], bound[0], bound[1], bound[2]);
    all.square += one.square;
    all.inside += one.inside;
    all.nees += one.nees;
    all.records += one.records;
    // Noise on the recorded torque enters the model's input; the bias it makes stays below a thousandth, give or take
    // four standard deviations of this mean.
    const double value[] = {wheel.inertia_kgm2, wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad};
    for (int k = 0; k < 3; ++k) EXPECT_LT(std::abs(bias[k]), 1e-3 + 4 * bound[k] / value[k] / std::sqrt(kRecords)) << k;
  }
  const Eigen::Vector3d ratio = (all.square / all.records).cwiseSqrt();
  std::printf("%-28s all    rmse/bound %.3f %.3f %.3f  95%% covers %.3f  NEES %.2f\n", noise.what, ratio[0], ratio[1],
              ratio[2], all.inside.sum() / (3 * all.records), all.nees / all.records);
  // 600 records estimate a ratio to 3 % (one standard deviation) and the pooled coverage to 0.6 %.
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(ratio[k], 0.9) << k;
    EXPECT_LT(ratio[k], 1.1) << k;
  }
  EXPECT_GT(all.inside.sum() / (3 * all.records), 0.93);
  EXPECT_LT(all.inside.sum() / (3 * all.records), 0.97);
  // Chi-square with 1800 degrees of freedom, over 600: 3 with a standard deviation of 0.1. Three of them.
  EXPECT_GT(all.nees / all.records, 2.7);
  EXPECT_LT(all.nees / all.records, 3.3);
}

INSTANTIATE_TEST_SUITE_P(Noise, MonteCarlo,
                         ::testing::Values(Noise{"0.03 degree", 0.03, 0}, Noise{"0.1 degree", 0.1, 0},
                                           Noise{"0.03 degree, 2 % unmeasured", 0.03, 0.02},
                                           Noise{"0.03 degree, 10 % unmeasured", 0.03, 0.10},
                                           Noise{"0.03 degree, 10 %, one low pass", 0.03, 0.10, 1, 0.25}));

}  // namespace
