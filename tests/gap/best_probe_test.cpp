// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a probe is worth, against the responses of linear wheels in closed form.
#include "gap/diagnosis/best_probe.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "gap/drawn_drive.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr double kLag_s = 0.012;
constexpr double kAngleVariance = 4e-7;
constexpr double kTorqueVariance = 9e-4;

Standing plain(const WheelArm& wheel) {
  Standing out;
  out.name = "no change";
  out.weight = 0.3;
  out.at.wheel = wheel;
  out.fitted = fitted_parameters(wheel, {});
  return out;
}

Standing lagging(const WheelArm& wheel) {
  Standing out = plain(wheel);
  out.name = "lag";
  out.at.effects.emplace_back(effect::lag).values = {kLag_s};
  out.fitted = fitted_parameters(wheel, hypotheses_of(out.at.effects));
  return out;
}

/// Nats between a wheel and one whose angle lags, J, B and C free: the tones of a multisine stand one in every line of
/// a period, and every period says the same.
double nats_in_closed_form(const WheelArm& wheel, const ProbeProposal& probe) {
  const auto first = std::lround(probe.low_hz * probe.period_s);
  const auto last = std::lround(probe.high_hz * probe.period_s);
  const auto tones = last - first + 1;
  const double samples = 100 * probe.period_s;
  const double torque = probe.rms_nm * std::sqrt(2.0 / static_cast<double>(tones)) * std::sqrt(samples) / 2;
  Eigen::MatrixXd columns(2 * tones, 3);
  Eigen::VectorXd difference(2 * tones);
  for (long k = 0; k < tones; ++k) {
    const std::complex<double> s(0, 2 * std::numbers::pi * static_cast<double>(first + k) / probe.period_s);
    const std::complex<double> h =
        1.0 / (wheel.inertia_kgm2 * s * s + wheel.damping_nms_per_rad * s + wheel.stiffness_nm_per_rad);
    const std::complex<double> passed = h / (1.0 + kLag_s * s);
    const double weight = torque / std::sqrt(kAngleVariance + std::norm(passed) * kTorqueVariance);
    const auto set = [&](Eigen::Ref<Eigen::VectorXd> column, std::complex<double> value) {
      column[k] = weight * value.real();
      column[tones + k] = weight * value.imag();
    };
    set(difference, passed - h);
    set(columns.col(0), h * h * s * s);
    set(columns.col(1), h * h * s);
    set(columns.col(2), h * h);
  }
  const Eigen::VectorXd moved = columns.colPivHouseholderQr().solve(difference);
  return probe.duration_s / probe.period_s * (difference - columns * moved).squaredNorm();
}

class BestProbe : public testing::Test {
 protected:
  [[nodiscard]] NextExperiment proposed(double noise, double dispersion = 1) const {
    NoiseFloor floor;
    floor.angle_variance = noise * kAngleVariance;
    floor.torque_variance = noise * kTorqueVariance;
    return best_probe({lagging(what_.wheel), plain(what_.wheel)},
                      {.prepared = prepared_, .floor = floor, .dispersion = dispersion, .threads = 1});
  }

  test::DrawnDrive what_{.duration_s = 20};
  Record record_ = test::drive(what_, test::seed(141));
  Simulation simulation_{.wheel = what_.wheel, .effects = {}, .sensors_json = {}};
  PreparedRecord prepared_{record_, simulation_, {}};
};

TEST_F(BestProbe, IsWorthWhatTheResponsesSay) {
  const NextExperiment next = proposed(1);
  ASSERT_FALSE(next.separates[0].empty()) << next.why;
  EXPECT_EQ(next.separates[0], "lag");
  EXPECT_EQ(next.separates[1], "no change");
  // The proposal is rounded down to two digits, by less than a tenth; a block's ends take six of two numbers a tone.
  const double nats = nats_in_closed_form(what_.wheel, next.probe);
  const double tones = next.probe.period_s * (next.probe.high_hz - next.probe.low_hz) + 1;
  EXPECT_GT(next.separation, nats * (1 - 2 * 6 / (2 * tones)));
  EXPECT_LT(next.separation, nats * 1.1 * 1.1);
}

/// No least torque is set by hand: what is lost in the noise separates nothing.
TEST_F(BestProbe, IsNoneWhereTheNoiseHidesWhatItWouldSeparate) {
  const double nats = proposed(1).separation;
  EXPECT_TRUE(proposed(1.2 * nats / settling_nats()).separates[0].empty());
  EXPECT_FALSE(proposed(1.2 * nats / settling_nats()).why.empty());
  EXPECT_FALSE(proposed(0.8 * nats / settling_nats()).separates[0].empty());
  // Nats that no model reaches the floor with count for less.
  EXPECT_TRUE(proposed(1, 1.2 * nats / settling_nats()).separates[0].empty());
  EXPECT_FALSE(proposed(1, 0.8 * nats / settling_nats()).separates[0].empty());
}

/// What is far from the answer is told from it by any probe. What settles the change is that its like is told, too.
TEST_F(BestProbe, SettlesAChangeByTheModelThatIsToldLeast) {
  const auto proposed_with = [&](const EffectType* of_like) {
    Standing none = plain(what_.wheel);
    none.doubted = &effect::lag;
    Standing like = plain(what_.wheel);
    like.name = "delay";
    like.doubted = of_like;
    like.at.effects.emplace_back(effect::delay).values = {kLag_s};
    like.fitted = fitted_parameters(what_.wheel, hypotheses_of(like.at.effects));
    NoiseFloor floor;
    floor.angle_variance = kAngleVariance;
    floor.torque_variance = kTorqueVariance;
    return best_probe({lagging(what_.wheel), none, like},
                      {.prepared = prepared_, .floor = floor, .dispersion = 1, .threads = 1});
  };
  const NextExperiment apart = proposed_with(&effect::delay);
  const NextExperiment together = proposed_with(&effect::lag);
  EXPECT_EQ(apart.separates[1], "no change");
  EXPECT_EQ(together.separates[1], "delay");
  EXPECT_LT(together.separation, apart.separation);
}

}  // namespace
}  // namespace steerid::gap
