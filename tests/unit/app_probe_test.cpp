// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The probe: its lines, its size, its limits, and everything that stops it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "app/probe.hpp"

namespace steerid {
namespace {

constexpr ProbeConditions kGo{.allowed = true};
/// Nothing is known of the arm, nor how large a probe has to be.
constexpr ProbeNeed kAllUnknown{.worst_256 = 12 * 256, .best_256 = 4 * 256};
constexpr ProbeNeed kReached{.worst_256 = 256, .best_256 = 200, .needed_mnm = 400};

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

double root_mean_square(const std::vector<std::int32_t>& torque) {
  double sum = 0;
  for (const double t : torque) sum += t * t;
  return std::sqrt(sum / static_cast<double>(torque.size()));
}

/// Of which a need has been told, for so long that patience and ramp are over: 3 s and ten time constants.
Probe aimed(const ProbeNeed& need, const ProbeLimits& limits = Probe::kGentle) {
  Probe probe(limits);
  probe.aim(need);
  static_cast<void>(run(probe, kGo, 2860));
  return probe;
}

TEST(Probe, IsOffUnlessPermittedAndNeeded) {
  Probe probe;
  EXPECT_EQ(largest(run(probe, kGo, 5000)), 0);  // nobody has said what is needed
  probe.aim(kReached);
  EXPECT_EQ(largest(run(probe, kGo, 5000)), 0);
  probe.aim(kAllUnknown);
  EXPECT_EQ(largest(run(probe, {.allowed = false}, 5000)), 0);
  EXPECT_EQ(largest(run(probe, kGo, 290)), 0);  // it is patient for 3 s
  EXPECT_GT(largest(run(probe, kGo, 300)), 100);
}

/// Amplitudes of the lines over 10 s, by Fourier's sums at multiples of 0.1 Hz; [0] is what else there is.
std::vector<double> lines_of(Probe& probe, const std::vector<int>& dhz) {
  const std::vector<std::int32_t> torque = run(probe, kGo, 1000);
  std::vector<double> found(dhz.size() + 1);
  for (int k = 1; k < 500; ++k) {
    double re = 0;
    double im = 0;
    for (int i = 0; i < 1000; ++i) {
      const double angle = 2 * M_PI * k * i / 1000;
      re += torque[static_cast<std::size_t>(i)] * std::cos(angle) / 500;
      im += torque[static_cast<std::size_t>(i)] * std::sin(angle) / 500;
    }
    const auto line = std::find(dhz.begin(), dhz.end(), k);
    double& at = found[line == dhz.end() ? 0 : 1 + static_cast<std::size_t>(line - dhz.begin())];
    at = std::max(at, std::hypot(re, im));
  }
  return found;
}

// 35, 35 and 30 % of the power of 1 Nm rms: amplitudes sqrt(0.7), sqrt(0.7) and sqrt(0.6) Nm. The gentle bound of the
// rate bites for a tick or two where all lines rise at once, and takes up to 6 mNm; without it rounding to a
// millinewton metre and the size, which comes to rest within 1, leave less than 2.
TEST(Probe, StandsAtTheResonanceOfTheArmAndAbove) {
  for (const auto& [told, resonance] : {std::pair{23, 23}, {18, 18}, {32, 32}, {11, 15}, {60, 35}}) {
    ProbeNeed need = kAllUnknown;
    need.best_256 = 256;  // something is known: it does not rest
    need.resonance_dhz = told;
    static constexpr ProbeLimits kQuick{.rate_mnm_per_tick = 2000};
    Probe probe = aimed(need, kQuick);
    const std::vector<double> found = lines_of(probe, {resonance, resonance + 8, 55});
    EXPECT_LT(found[0], 2) << told;
    EXPECT_NEAR(found[1], 1000 * std::sqrt(0.7), 2) << told;
    EXPECT_NEAR(found[2], 1000 * std::sqrt(0.7), 2) << told;
    EXPECT_NEAR(found[3], 1000 * std::sqrt(0.6), 2) << told;
  }
}

TEST(Probe, HasTheSizeThatIsNeeded) {
  const auto size_of = [](double over, std::int32_t needed_mnm) {
    return aimed({.worst_256 = static_cast<std::int32_t>(256 * over), .best_256 = 256, .needed_mnm = needed_mnm})
        .size_mnm();
  };
  EXPECT_NEAR(size_of(1.25, 400), 400, 2);  // 4 (r - 1) = 1; the size comes to rest within 1
  EXPECT_NEAR(size_of(1.25, 200), 200, 2);
  EXPECT_NEAR(size_of(1.125, 400), 200, 2);
  EXPECT_NEAR(size_of(1.5, 400), 800, 2);
  EXPECT_NEAR(size_of(2, 400), 1000, 2);      // the limit
  EXPECT_NEAR(size_of(1.25, 0), 1000, 2);     // nobody knows what is needed
  EXPECT_NEAR(size_of(1.125, 9000), 500, 2);  // more than the limit is not needed
  EXPECT_EQ(size_of(1, 400), 0);
  EXPECT_EQ(size_of(0.2, 400), 0);
}

TEST(Probe, RemembersWhatWasNeededWhileNobodyCanTell) {
  Probe probe = aimed({.worst_256 = 320, .best_256 = 256, .needed_mnm = 400});
  probe.aim({.worst_256 = 320, .best_256 = 256, .needed_mnm = 0});
  static_cast<void>(run(probe, kGo, 2000));
  EXPECT_NEAR(probe.size_mnm(), 400, 2);
}

TEST(Probe, KeepsToItsLimits) {
  for (const ProbeLimits& limits : {ProbeLimits{}, ProbeLimits{.amplitude_mnm = 1000},
                                    ProbeLimits{.amplitude_mnm = 5000, .rms_mnm = 2000, .rate_mnm_per_tick = 60}}) {
    Probe probe(limits);
    probe.aim({.worst_256 = 12 * 256, .best_256 = 256});
    const std::vector<std::int32_t> torque = run(probe, kGo, 30000);
    EXPECT_LE(largest(torque), limits.amplitude_mnm);
    EXPECT_LE(root_mean_square(torque), limits.rms_mnm);
    std::int32_t step = 0;
    for (std::size_t i = 1; i < torque.size(); ++i) step = std::max(step, std::abs(torque[i] - torque[i - 1]));
    EXPECT_LE(step, limits.rate_mnm_per_tick);
    EXPECT_GT(step, 20);
    if (limits.rate_mnm_per_tick < 500) continue;
    // And it is not timid: a limit that never bites says nothing.
    EXPECT_GT(largest(torque), 3 * limits.amplitude_mnm / 4);
  }
}

TEST(Probe, RisesAndFallsSoftly) {
  Probe probe;
  probe.aim(kAllUnknown);
  static_cast<void>(run(probe, kGo, 300));
  EXPECT_LT(largest(run(probe, kGo, 20)), 250);  // a tenth of its 2.4 Nm at most, by a time constant of 256 ticks
  static_cast<void>(run(probe, kGo, 1400));
  probe.aim(kReached);
  const std::vector<std::int32_t> fall = run(probe, kGo, 2000);
  EXPECT_GT(largest({fall.begin(), fall.begin() + 100}), 800);
  EXPECT_LT(largest({fall.begin() + 768, fall.begin() + 1000}), 2449 / 20 + 2);  // exp(-3)
  EXPECT_EQ(probe.size_mnm(), 0);
  EXPECT_EQ(fall.back(), 0);
}

// A small one begins with less than the millinewton metre at which one that fades ends.
TEST(Probe, BeginsHoweverLittleIsNeeded) {
  EXPECT_NEAR(aimed({.worst_256 = 320, .best_256 = 256, .needed_mnm = 20}).size_mnm(), 20, 2);
}

TEST(Probe, StopsAtOnceForEveryReasonAndPausesThen) {
  ProbeConditions fault = kGo;
  fault.fault = true;
  ProbeConditions withdrawn = kGo;
  withdrawn.allowed = false;
  ProbeConditions left = kGo;
  left.torque_driver_mnm = 4001;
  ProbeConditions right = kGo;
  right.torque_driver_mnm = -4001;
  ProbeConditions fast = kGo;
  fast.angle_step_urad = -30001;
  for (const ProbeConditions& reason : {fault, withdrawn, left, right, fast}) {
    Probe probe = aimed(kAllUnknown);
    ASSERT_GT(probe.size_mnm(), 900);
    EXPECT_EQ(probe.next(reason), 0);
    EXPECT_EQ(probe.size_mnm(), 0);
    EXPECT_EQ(largest(run(probe, kGo, 6000)), 0);  // the pause of 60 s
    EXPECT_GT(largest(run(probe, kGo, 600)), 100);
  }
  ProbeConditions just_inside = kGo;
  just_inside.torque_driver_mnm = 4000;
  just_inside.angle_step_urad = 30000;
  Probe probe = aimed(kAllUnknown);
  EXPECT_GT(largest(run(probe, just_inside, 100)), 100);
}

TEST(Probe, RestsAfterHalfAMinuteAtItsLimitWhenNothingComesOfIt) {
  Probe probe;
  probe.aim(kAllUnknown);
  static_cast<void>(run(probe, kGo, 300 + 2990));
  EXPECT_GT(probe.size_mnm(), 900);
  static_cast<void>(run(probe, kGo, 2000));
  EXPECT_EQ(probe.size_mnm(), 0);
  EXPECT_EQ(largest(run(probe, kGo, 4000)), 0);
  EXPECT_GT(largest(run(probe, kGo, 600)), 100);
}

// As long as something comes of it it goes on, and so does one below its limit.
TEST(Probe, GoesOnAsLongAsSomethingIsKnown) {
  for (const ProbeNeed& need : {ProbeNeed{.worst_256 = 12 * 256, .best_256 = 512},
                                ProbeNeed{.worst_256 = 320, .best_256 = 1024, .needed_mnm = 500}}) {
    Probe probe = aimed(need);
    static_cast<void>(run(probe, kGo, 20000));
    EXPECT_GT(probe.size_mnm(), 400);
  }
}

}  // namespace
}  // namespace steerid
