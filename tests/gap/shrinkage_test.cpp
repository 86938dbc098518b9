// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The closed fraction and its interval, on angles made up of a known gap and known noise.
#include "gap/diagnosis/shrinkage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "gap/drawn_drive.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr double kNoise_rad = 0.001;
constexpr double kGap_rad = 0.01;  // rms

/// 100 s of a swing; the refit misses the gap, the simulation with the effect a part of it.
struct MadeUp {
  Record record;
  std::vector<Block> blocks;
  std::vector<double> refit_rad;
  std::vector<double> with_effect_rad;

  MadeUp(double missed, std::uint64_t seed, double gap_rad = kGap_rad, double from_s = 0) {
    test::Noise noise(seed);
    for (int i = 0; i < 10000; ++i) {
      const double t = i / 100.0;
      const double swing = 0.3 * std::sin(2 * std::numbers::pi * 0.3 * t);
      const double there = t < from_s ? 0 : gap_rad;
      const double gap = there * std::numbers::sqrt2 * std::sin(2 * std::numbers::pi * 0.9 * t);
      record.time_s.push_back(t);
      record.torque_driver_nm.push_back(0);
      record.torque_motor_nm.push_back(0);
      record.angle_rad.push_back(swing + gap + kNoise_rad * noise());
      refit_rad.push_back(swing);
      with_effect_rad.push_back(swing + (1 - missed) * gap);
    }
    blocks = held_out_split(record);
  }

  /// `noise_rad`: what the floor is thought to be.
  [[nodiscard]] GapSizes sizes(double noise_rad, std::vector<double> unsure_rad2 = {}) const {
    NoiseFloor floor;
    floor.angle_variance = noise_rad * noise_rad;
    return shrinkage({.record = record,
                      .blocks = blocks,
                      .sim_rad = refit_rad,
                      .refit_rad = refit_rad,
                      .with_effect_rad = with_effect_rad,
                      .gain = [](double) { return 0.0; },
                      .floor = floor,
                      .unsure_rad2 = std::move(unsure_rad2)});
  }
};

/// (r - e)/(r - f) with r^2 = gap^2 + noise^2, e^2 = (missed gap)^2 + noise^2, f = noise: a gap of ten times the noise
/// of which a tenth is missed closes (10.050 - 1.414)/(10.050 - 1) = 95.4 %.
TEST(ClosedFraction, IsTheClosedForm) {
  const BoundedValue found = MadeUp(0.1, test::seed(91)).sizes(kNoise_rad).closed_fraction;
  EXPECT_NEAR(found.value, 0.954, 0.005);
  EXPECT_LT(found.high, 0.99);  // nothing says that more of it is the effect's
  EXPECT_GT(found.low, 0.92);
  EXPECT_LE(found.low, found.value);
}

TEST(ClosedFraction, AllThatNoiseLeavesIsClosed) {
  const BoundedValue found = MadeUp(0, test::seed(92)).sizes(kNoise_rad).closed_fraction;
  EXPECT_NEAR(found.value, 1, 0.005);
  EXPECT_EQ(found.high, std::max(1.0, found.value));
  EXPECT_GT(found.low, 0.98);
}

/// What the numbers of the effect may be off by is not the effect's: with that known the upper end reaches all of it,
/// and with half of that it does not. The lower end knows nothing of it.
TEST(ClosedFraction, ReachesAsFarAsTheNumbersLeaveOpen) {
  const MadeUp drive(0.1, test::seed(93));
  const double off_rad2 = std::pow(0.1 * kGap_rad, 2);
  const BoundedValue known = drive.sizes(kNoise_rad).closed_fraction;
  const BoundedValue unsure = drive.sizes(kNoise_rad, {1.1 * off_rad2}).closed_fraction;
  EXPECT_EQ(unsure.high, 1);
  EXPECT_EQ(unsure.low, known.low);
  EXPECT_LT(drive.sizes(kNoise_rad, {0.5 * off_rad2}).closed_fraction.high, 0.995);
}

/// A floor that is thought to be twice what is left cannot be: nobody is sure of more than all.
TEST(ClosedFraction, AFloorAboveWhatIsLeftMakesNothingSure) {
  const BoundedValue found = MadeUp(0, test::seed(95)).sizes(2 * kNoise_rad).closed_fraction;
  EXPECT_GT(found.value, 1.1);  // (10.05 - 1)/(10.05 - 2)
  EXPECT_LE(found.low, 1);
  EXPECT_EQ(found.high, found.value);
}

/// A gap of half the noise: r = 1.118 f, which is more than the tenth to which a floor is known, and by chance only.
/// What closes of it was said to be -5975 to 100 %.
TEST(ClosedFraction, IsNotToldWhereChanceMakesTheGap) {
  const BoundedValue hidden = MadeUp(1, test::seed(96), kNoise_rad / 2).sizes(kNoise_rad).closed_fraction;
  EXPECT_TRUE(std::isnan(hidden.value));
  EXPECT_EQ(hidden.low, -std::numeric_limits<double>::infinity());
  const BoundedValue seen = MadeUp(0, test::seed(96), 2 * kNoise_rad).sizes(kNoise_rad).closed_fraction;
  EXPECT_NEAR(seen.value, 1, 0.1);
  EXPECT_GT(seen.low, 0.5);
}

/// What begins late in the record is missing in some draws of its pieces, and is a gap all the same.
TEST(ClosedFraction, IsToldOfAGapInAPartOfTheRecord) {
  const BoundedValue found = MadeUp(0.1, test::seed(97), kGap_rad, 80).sizes(kNoise_rad).closed_fraction;
  EXPECT_NEAR(found.value, 0.97, 0.02);  // a fifth of the time: (4.58 - 1.10)/(4.58 - 1)
  EXPECT_GT(found.low, 0.6);
  EXPECT_LE(found.high, 1);
}

}  // namespace
}  // namespace steerid::gap
