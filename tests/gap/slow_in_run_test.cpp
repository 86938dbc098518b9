// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The slow torque that a free run misses, on drawn drives (gap/drawn_drive.hpp).
#include "gap/model/slow_in_run.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "gap/compared_drive.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// Of the linear wheel on a drive with the torque.
double share_with(const std::function<double(double)>& torque_nm, std::uint64_t seed) {
  test::DrawnDrive what;
  what.torque = [&](double t, double, double) { return torque_nm(t); };
  const test::ComparedDrive one(what, seed);
  SimulatedModel model(one.spectral, {});
  const Whittle::Fit right = one.judged(model, joined(one.drive.wheel, {}), {});
  return slow_share_of_run(one.spectral, one.whittle, model, right) * one.spectral.applied_rms_nm / what.probe_rms_nm;
}

TEST(SlowInRun, IsThatOfTheTorque) {
  // Two sines of 20 and 8 s. The seen blocks are three quarters of a minute: their share of a sine's power is between
  // 0.9 and 1.1 of what it is in the mean, and the share is its root.
  const auto torque = [](double t) { return 0.15 * std::cos(0.314 * t) + 0.1 * std::cos(0.785 * t + 1); };
  const double expected = std::sqrt((0.15 * 0.15 + 0.1 * 0.1) / 2) / test::DrawnDrive{}.probe_rms_nm;
  EXPECT_NEAR(share_with(torque, test::seed(81)) / expected, 1, 0.07);
}

TEST(SlowInRun, NoiseHasNone) {
  // Below 1 Hz white noise of 0.02 Nm, and of 0.6 mrad behind 22.7 Nm/rad, is 0.0034 Nm, 0.2 % of the applied torque.
  // It is taken off in the mean; half a per cent is a quarter of what every driver may have.
  const double share = share_with([](double) { return 0.0; }, test::seed(82));
  EXPECT_LT(share, 0.005);
}

/// What changes within half a minute only, of so much of the applied torque.
std::string verdict_with_slow(double share, std::uint64_t seed) {
  test::DrawnDrive what;
  what.duration_s = 100;
  test::Noise noise(seed);
  constexpr std::size_t kTones = 12;
  std::array<double, kTones> phase{};
  for (double& one : phase) one = 2 * std::numbers::pi * noise.uniform();
  const double each_nm = share * what.probe_rms_nm * std::sqrt(2.0 / kTones);
  what.torque = [=](double t, double, double) {
    double sum = 0;
    for (std::size_t k = 0; k < kTones; ++k) {
      sum += std::cos(2 * std::numbers::pi * 0.01 * static_cast<double>(k + 1) * t + phase[k]);
    }
    return each_nm * sum;
  };
  return diagnose(test::drive(what, seed), test::off_by_five_percent(what.wheel)).verdict;
}

TEST(SlowInRun, ATorqueThatBlocksCannotShowIsUnmeasured) {
  const std::uint64_t seed = test::seed(83);
  for (std::uint64_t draw = 0; draw < 2; ++draw) {
    EXPECT_EQ(verdict_with_slow(0.065, seed + draw), "unmeasured_torque") << draw;
    EXPECT_EQ(verdict_with_slow(0.018, seed + draw), "parameters") << draw;
  }
}

}  // namespace
}  // namespace steerid
