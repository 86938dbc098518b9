// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The wheel that runs freely against its closed forms, and what its motion shows under noise and under a drive.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

#include "identifier/modelled_motion.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kPeriod_s = 0.01;
constexpr double kCorner = 631.65, kDamping_per_s = 35.19;  // the common filter's, as the follower has it

TEST(FreeWheel, ComesToRestWhereItsSpringHoldsTheTorque) {
  FreeWheel<double> wheel;
  wheel.become(Vector3<double>(0.11, 1.5, 22.7), kPeriod_s);
  Moved<double> moved;
  for (int k = 0; k < 1000; ++k) moved = wheel.move(3, kPeriod_s);
  EXPECT_NEAR(moved.to, 3 / 22.7, 1e-9);
  EXPECT_NEAR(moved.by, 0, 1e-12);
}

// The step's own frequency is asin(w T / 2) 2 / T: within (w T)^2 / 24 = 0.3 % of w.
TEST(FreeWheel, SwingsAtItsOwnFrequency) {
  const double w = std::sqrt(80 / 0.11);
  FreeWheel<double> wheel;
  wheel.become(Vector3<double>(0.11, 0.0001, 80), kPeriod_s);
  wheel.start_at(0.1, 0);
  int turns = 0;
  double before = 0.1, last = 0, first = 0;
  for (int k = 1; k <= 2000; ++k) {
    const double now = wheel.move(0, kPeriod_s).to;
    if (before < 0 && now >= 0) {
      last = (k - now / (now - before)) * kPeriod_s;
      if (turns++ == 0) first = last;
    }
    before = now;
  }
  ASSERT_GT(turns, 50);
  EXPECT_NEAR(2 * std::numbers::pi * (turns - 1) / (last - first) / w, 1, 0.005);
}

TEST(FreeWheel, IsNeverOneThatHardlyComesToRest) {
  FreeWheel<double> wheel;
  wheel.become(Vector3<double>(0.11, 2, 0.01), kPeriod_s);
  Moved<double> moved;
  for (int k = 0; k < 2000; ++k) moved = wheel.move(3, kPeriod_s);
  EXPECT_NEAR(moved.to, 3 / 2.0, 1e-6);  // as of C = B / 1 s
}

/// Looks of `seconds` under white noise of `noise_nm` and a sine of `sine_nm` at `hz`; returns in how many J, B, C are
/// unexcited, of those after the first two seconds.
std::array<double, 3> dark_share(const Vector3<double>& arm, double noise_nm, double sine_nm, double hz, double seconds,
                                 std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto common = second_order_coefficients(kCorner, kDamping_per_s, kPeriod_s);
  SecondOrderFilter<double> filter;
  ModelledMotion<double> motion;
  motion.start(arm, {}, Differentiator<double>(), kPeriod_s);
  const auto pretended =
      noise_information(arm, kCorner, kDamping_per_s, noise_nm * noise_nm, kPeriod_s, WhiteningShape<double>());
  std::array<double, 3> dark{};
  int counted = 0;
  const int samples = static_cast<int>(seconds / kPeriod_s);
  for (int k = 1; k <= samples; ++k) {
    const double torque = noise_nm * normal(random) + sine_nm * std::sin(2 * std::numbers::pi * hz * kPeriod_s * k);
    motion.push(filter.step(torque, common, kPeriod_s), kPeriod_s);
    if (k % 4 != 0) continue;
    motion.look(motion.derivatives(1 / kPeriod_s), arm, kPeriod_s);
    if (k % 40 == 0) motion.compare(pretended);
    if (k * kPeriod_s < 2) continue;
    ++counted;
    for (std::size_t i = 0; i < 3; ++i) dark[i] += motion.dark()[i];
  }
  for (double& share : dark) share /= counted;
  return dark;
}

// A ratio of 20 where 1 is expected: the mean of 20 looks and more, of which at least three are independent, has it
// once in 10^9.
TEST(ModelledMotion, IsUnexcitedUnderTheTorquesNoiseAloneWhateverTheArm) {
  for (const auto& arm :
       {Vector3<double>(0.11, 1.5, 22.7), Vector3<double>(0.05, 0.3, 6), Vector3<double>(0.15, 3, 80)}) {
    for (const double share : dark_share(arm, 0.03, 0, 1, 60, test::seed(3))) EXPECT_EQ(share, 1);
  }
}

// A sine at w has th'' = w^2 th: against noise that J sees above, C below the wheel's frequency, slow motion shows C
// and no J, and fast motion shows both.
TEST(ModelledMotion, ShowsWhatTheDriveDoes) {
  const Vector3<double> arm(0.11, 1.5, 22.7);
  const auto slow = dark_share(arm, 0.03, 1, 0.1, 30, test::seed(4));
  EXPECT_EQ(slow[kStiffness], 0);
  EXPECT_EQ(slow[kInertia], 1);
  const auto fast = dark_share(arm, 0.03, 1, 2, 30, test::seed(5));
  for (const double share : fast) EXPECT_EQ(share, 0);
}

}  // namespace
}  // namespace steerid
