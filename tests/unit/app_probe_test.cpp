// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe: its limits, its ramps, and everything that stops it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "app/probe.hpp"

namespace steerid {
namespace {

constexpr ProbeConditions kWanted{.allowed = true, .dark = true};

std::vector<std::int32_t> run(Probe& probe, const ProbeConditions& now, int ticks) {
  std::vector<std::int32_t> torque;
  for (int i = 0; i < ticks; ++i) torque.push_back(probe.next(now));
  return torque;
}

std::int32_t largest(const std::vector<std::int32_t>& torque) {
  std::int32_t most = 0;
  for (const std::int32_t t : torque) most = std::max(most, std::abs(t));
  return most;
}

/// A probe at full strength: 3 s of patience, 2 s of rise, and some.
Probe running() {
  Probe probe;
  static_cast<void>(run(probe, kWanted, 700));
  EXPECT_EQ(probe.phase(), Probe::Phase::kFull);
  return probe;
}

TEST(Probe, IsOffUnlessPermittedAndWanted) {
  Probe probe;
  EXPECT_EQ(largest(run(probe, {.allowed = false, .dark = true}, 5000)), 0);
  EXPECT_EQ(largest(run(probe, {.allowed = true, .dark = false}, 5000)), 0);
  EXPECT_EQ(largest(run(probe, kWanted, 290)), 0);  // it is patient for 3 s
  EXPECT_GT(largest(run(probe, kWanted, 300)), 100);
}

TEST(Probe, KeepsToItsAmplitudeAndRate) {
  for (const ProbeLimits& limits : {ProbeLimits{}, ProbeLimits{.amplitude_mnm = 5000, .rate_mnm_per_tick = 60}}) {
    Probe probe(limits);
    const std::vector<std::int32_t> torque = run(probe, kWanted, 30000);
    EXPECT_LE(largest(torque), limits.amplitude_mnm);
    EXPECT_GT(largest(torque), limits.amplitude_mnm / 3);  // and it is not timid: a limit that never bites says nothing
    std::int32_t step = 0;
    for (std::size_t i = 1; i < torque.size(); ++i) step = std::max(step, std::abs(torque[i] - torque[i - 1]));
    EXPECT_LE(step, limits.rate_mnm_per_tick);
    EXPECT_GT(step, 20);
  }
}

TEST(Probe, HoldsItsTonesAndNothingElse) {
  Probe probe;
  const std::vector<std::int32_t> torque = run(probe, kWanted, 1700);
  // Over the last period of 10 s the sum is periodic: amplitudes by Fourier's sums at multiples of 0.1 Hz.
  double inside = 0;
  for (int k = 1; k < 500; ++k) {
    double re = 0;
    double im = 0;
    for (int i = 0; i < 1000; ++i) {
      const double angle = 2 * M_PI * k * i / 1000;
      re += torque[static_cast<std::size_t>(700 + i)] * std::cos(angle) / 500;
      im += torque[static_cast<std::size_t>(700 + i)] * std::sin(angle) / 500;
    }
    const bool tone = k == 2 || k == 5 || k == 9 || k == 16 || k == 28 || k == 50;
    // A sixth of 3 Nm each; rounding to a millinewton metre leaves less than one between them.
    EXPECT_NEAR(std::hypot(re, im), tone ? 500 : 0, 1.0) << k;
    if (tone) inside += re * re + im * im;
  }
  EXPECT_NEAR(std::sqrt(inside / 2), 866, 5);
}

TEST(Probe, RisesAndFallsSoftly) {
  Probe probe;
  static_cast<void>(run(probe, kWanted, 300));
  EXPECT_LT(largest(run(probe, kWanted, 20)), 300);  // a tenth of the ramp
  static_cast<void>(run(probe, kWanted, 1400));
  const std::vector<std::int32_t> fall = run(probe, {.allowed = true, .dark = false}, 250);
  EXPECT_GT(largest({fall.begin(), fall.begin() + 100}), 200);
  EXPECT_LT(largest({fall.begin() + 181, fall.end()}), 300);
  EXPECT_EQ(probe.phase(), Probe::Phase::kOff);
  EXPECT_EQ(fall.back(), 0);
}

TEST(Probe, StopsAtOnceForEveryReasonAndPausesThen) {
  ProbeConditions fault = kWanted;
  fault.fault = true;
  ProbeConditions withdrawn = kWanted;
  withdrawn.allowed = false;
  ProbeConditions left = kWanted;
  left.torque_driver_mnm = 4001;
  ProbeConditions right = kWanted;
  right.torque_driver_mnm = -4001;
  ProbeConditions fast = kWanted;
  fast.angle_step_urad = -30001;
  for (const ProbeConditions& reason : {fault, withdrawn, left, right, fast}) {
    Probe probe = running();
    EXPECT_EQ(probe.next(reason), 0);
    EXPECT_EQ(probe.phase(), Probe::Phase::kOff);
    EXPECT_EQ(largest(run(probe, kWanted, 6000)), 0);  // the pause of 60 s
    EXPECT_GT(largest(run(probe, kWanted, 600)), 100);
  }
  ProbeConditions just_inside = kWanted;
  just_inside.torque_driver_mnm = 4000;
  just_inside.angle_step_urad = 30000;
  Probe probe = running();
  EXPECT_GT(largest(run(probe, just_inside, 100)), 100);
}

TEST(Probe, EndsAfterHalfAMinuteEvenWhenNothingComesOfIt) {
  Probe probe;
  const std::vector<std::int32_t> torque = run(probe, kWanted, 300 + 200 + 3000 + 205);
  EXPECT_EQ(torque.back(), 0);
  EXPECT_EQ(probe.phase(), Probe::Phase::kOff);
}

}  // namespace
}  // namespace steerid
