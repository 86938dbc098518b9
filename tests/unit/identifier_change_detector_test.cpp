// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The change detector against noise and steps whose statistics are known.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "identifier/change_detector.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

// Twenty hours of noise as it should be.
TEST(ChangeDetector, DoesNotRingOnNoiseAlone) {
  std::mt19937_64 random(test::seed(9));
  std::normal_distribution<double> normal;
  ChangeDetector<double> detector;
  for (int k = 0; k < 7'200'000; ++k) {
    const double e = normal(random);
    ASSERT_FALSE(detector.surprised(e * e, e * e, 1.0, 0.0)) << "after " << k << " samples";
  }
}

// An innovation that is sqrt(20) times too large: the mean rises as 20 - 19 (15/16)^n and passes 8 at n = 7.1; chance
// moves that, but 40 samples in a row never average below 8.
TEST(ChangeDetector, RingsWithinFourTenthsOfASecond) {
  std::mt19937_64 random(test::seed(10));
  std::normal_distribution<double> normal;
  double mean_delay = 0;
  for (int run = 0; run < 200; ++run) {
    ChangeDetector<double> detector;
    for (int k = 0; k < 200; ++k) {
      const double e = normal(random);
      ASSERT_FALSE(detector.surprised(e * e, e * e, 1.0, 0.0));
    }
    int delay = 0;
    for (bool rung = false; !rung; ++delay) {
      const double e = std::sqrt(20.0) * normal(random);
      rung = detector.surprised(e * e, e * e, 1.0, 0.0);
      ASSERT_LT(delay, 40);
    }
    mean_delay += delay / 200.0;
  }
  EXPECT_GT(mean_delay, 5);
  EXPECT_LT(mean_delay, 15);
}

// What no sensor sees surprises as well; it is no other arm while it is a small part of the torque.
TEST(ChangeDetector, IsNotRungByWhatIsSmallAgainstTheTorque) {
  for (const double torque_square : {3.30, 3.37}) {
    ChangeDetector<double> detector;
    bool rung = false;
    for (int k = 0; k < 1000; ++k) rung = detector.surprised(50.0, 1.0, torque_square, 0.0) || rung;
    EXPECT_EQ(rung, torque_square < 1 / 0.3);
  }
}

// More than noise makes it suspicious, also where it is too little to be another arm.
TEST(ChangeDetector, IsSuspiciousBeforeItRings) {
  ChangeDetector<double> detector;
  EXPECT_FALSE(detector.suspicious());
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(detector.surprised(50.0, 0.1, 1.0, 0.0));
  EXPECT_TRUE(detector.suspicious());
  detector.reset();
  EXPECT_FALSE(detector.suspicious());
}

TEST(ChangeDetector, IsNotRungByOneSampleHoweverWild) {
  ChangeDetector<float> detector;
  EXPECT_FALSE(detector.surprised(1e30F, 1e30F, 1.0F, 0.0F));
  EXPECT_FALSE(detector.surprised(0.0F, 0.0F, 1.0F, 0.0F));
  detector.reset();
  // 1 + 29 (1 - (15/16)^n) passes 8 at n = 5.
  for (int n = 1; n < 5; ++n) EXPECT_FALSE(detector.surprised(50.0F, 50.0F, 1.0F, 0.0F));
  EXPECT_TRUE(detector.surprised(50.0F, 50.0F, 1.0F, 0.0F));
}

// Slow torque that is known to be unmeasured may jump: 0.07 of its power are expected.
TEST(ChangeDetector, IsNotRungByWhatIsSmallAgainstTheUnmeasuredTorque) {
  for (const double slow_power : {14.0, 14.6}) {
    ChangeDetector<double> detector;
    bool rung = false;
    for (int k = 0; k < 1000; ++k) rung = detector.surprised(50.0, 1.0, 0.0, slow_power) || rung;
    EXPECT_EQ(rung, slow_power < 1 / 0.07);
  }
}

}  // namespace
}  // namespace steerid
