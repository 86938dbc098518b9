// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether anybody holds a wheel above a torsion bar, on a column stepped here: a spring of 10 Nm/rad with the probe on
// it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "identifier/closed_loop_identifier.hpp"
#include "identifier/hands.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

struct Arm {
  double inertia_kgm2, damping_nms_per_rad, stiffness_nm_per_rad;
  double voluntary_nm;  ///< rms of what the driver pulls, below 0.3 Hz
};

class Wheel {
 public:
  /// `bar_off_nm`: by which the bar's sensor is off.
  explicit Wheel(std::uint64_t seed, double bar_off_nm = 0) : random_(seed), bar_off_nm_(bar_off_nm) {}

  /// A hundredth of a second of this arm; what the identifier is told of it.
  void tick(const Arm& arm, ClosedLoopIdentifier<double>& identifier) {
    constexpr double kStep_s = 2e-4;  // what it is late by is far below the noise
    const double pole = std::exp(-2 * std::numbers::pi * 0.3 * 0.01);
    for (double& lag : lag_) {
      const double in = &lag == lag_.data() ? normal_(random_) * 14 : lag_[0];
      lag = pole * lag + (1 - pole) * in;
    }
    for (int i = 0; i < 50; ++i) {
      time_s_ += kStep_s;
      probe_nm_ = 0;
      for (int k = 1; k <= 24; ++k) {
        probe_nm_ += 0.5 * std::sqrt(2.0 / 24) * std::cos(2 * std::numbers::pi * 0.25 * k * time_s_ + k * k);
      }
      const double torque_nm = arm.voluntary_nm * lag_[1] - arm.damping_nms_per_rad * rate_ -
                               arm.stiffness_nm_per_rad * angle_ + probe_nm_ - kColumn * angle_;
      rate_ += kStep_s * torque_nm / arm.inertia_kgm2;
      angle_ += kStep_s * rate_;
    }
    identifier.update(probe_nm_ - kColumn * angle_ + bar_off_nm_ + 0.03 * normal_(random_),
                      angle_ + 5e-4 * normal_(random_), probe_nm_);
  }

 private:
  static constexpr double kColumn = 10;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double bar_off_nm_;
  std::array<double, 2> lag_{};
  double angle_ = 0, rate_ = 0, probe_nm_ = 0, time_s_ = 0;
};

constexpr Arm kDriver{0.11, 1.4, 18, 1};
constexpr Arm kNobody{0.037, 0.07, 0, 0};
constexpr Arm kFingers{0.045, 0.2, 2.5, 0.1};

TEST(Hands, AreToldToHaveLeftWithinTwoSecondsAndToBeBackWithinOne) {
  Wheel wheel(test::seed(5));
  ClosedLoopIdentifier<double> identifier;
  for (int k = 0; k < 2000; ++k) wheel.tick(kDriver, identifier);
  EXPECT_LT(identifier.released(), 0.01);
  for (int k = 0; k < 200; ++k) wheel.tick(kNobody, identifier);
  EXPECT_GT(identifier.released(), 0.98);
  for (int k = 0; k < 1000; ++k) wheel.tick(kNobody, identifier);
  EXPECT_GT(identifier.released(), 0.8);  // a look may be a poor one
  // The wheel's own inertia, of which only 0.035 +- 0.008 was known.
  EXPECT_NEAR(identifier.value(kInertia), 0.037, 0.002);
  EXPECT_NEAR(identifier.value(kStiffness), 0, 1);
  for (int k = 0; k < 100; ++k) wheel.tick(kDriver, identifier);
  EXPECT_LT(identifier.released(), 0.05);
}

/// 0.2 Nm are fifty times what the bar's noise leaves behind the common filter.
TEST(Hands, AreToldToHaveLeftBesideASensorThatIsOff) {
  for (const double off_nm : {-0.2, 0.05, 0.2}) {
    Wheel wheel(test::seed(10), off_nm);
    ClosedLoopIdentifier<double> identifier;
    for (int k = 0; k < 2000; ++k) wheel.tick(kDriver, identifier);
    EXPECT_LT(identifier.released(), 0.01) << off_nm;
    for (int k = 0; k < 200; ++k) wheel.tick(kNobody, identifier);
    EXPECT_GT(identifier.released(), 0.98) << off_nm;
    for (int k = 0; k < 1000; ++k) wheel.tick(kNobody, identifier);
    EXPECT_NEAR(identifier.value(kInertia), 0.037, 0.002) << off_nm;
    EXPECT_NEAR(identifier.value(kStiffness), 0, 0.1) << off_nm;
  }
}

TEST(Hands, AreStillThereAsLongAsFingersPullALittle) {
  for (const double off_nm : {0.0, 0.2}) {
    Wheel wheel(test::seed(6), off_nm);
    ClosedLoopIdentifier<double> identifier;
    int told = 0;
    for (int k = 0; k < 6000; ++k) {
      wheel.tick(kFingers, identifier);
      told += identifier.released() > 0.99;
    }
    // In half a second of the minute at most: the task waits for a whole one.
    EXPECT_LT(told, 50) << off_nm;
  }
}

TEST(Hands, OfWhoRestsOnAWheelThatDoesNotMoveNothingIsConcluded) {
  std::mt19937_64 random(test::seed(7));
  std::normal_distribution<double> normal;
  ClosedLoopIdentifier<double> identifier;
  for (int k = 0; k < 6000; ++k) identifier.update(0.03 * normal(random), 5e-4 * normal(random), 0);
  EXPECT_LT(identifier.released(), 0.99);
}

TEST(ClosedLoopIdentifier, IsAfterARestartWhatANewOneIs) {
  Wheel before(test::seed(8));
  ClosedLoopIdentifier<double> restarted;
  for (int k = 0; k < 3000; ++k) before.tick(k < 2000 ? kDriver : kNobody, restarted);
  restarted.restart();
  ClosedLoopIdentifier<double> fresh;
  Wheel one(test::seed(9)), other(test::seed(9));
  for (int k = 0; k < 2500; ++k) {
    one.tick(k < 1800 ? kDriver : kNobody, restarted);
    other.tick(k < 1800 ? kDriver : kNobody, fresh);
    ASSERT_EQ(restarted.value(), fresh.value()) << k;
    ASSERT_EQ(restarted.standard_deviation(), fresh.standard_deviation()) << k;
    ASSERT_EQ(restarted.released(), fresh.released()) << k;
    for (int i = 0; i < 3; ++i) ASSERT_EQ(restarted.belief(i), fresh.belief(i)) << k;
  }
}

/// What white noise of variance 1 at 100 Hz leaves of itself behind the common filter of 4 Hz, one value in four and
/// four tenths of the one before taken off: by its impulse response.
TEST(Hands, KnowTheSensorsNoiseBehindTheCommonFilter) {
  constexpr double kPeriod_s = 0.01, kCorner_rad_per_s = 2 * std::numbers::pi * 4;
  const SecondOrderCoefficients<double> common =
      second_order_coefficients(kCorner_rad_per_s * kCorner_rad_per_s, 1.4 * kCorner_rad_per_s, kPeriod_s);
  SecondOrderFilter<double> filter;
  Differentiator<double> moved;
  constexpr std::array kMean = {0.25, 0.5, 0.25};
  constexpr BareWheel<double> kWheel{};
  std::vector<double> torque, by_angle;
  for (std::size_t k = 0; k < 400; ++k) {
    const Moved<double> out = filter.move(k < kMean.size() ? kMean[k] : 0, common, kPeriod_s);
    torque.push_back(out.to);
    moved.push(out);
    const Vector3<double> motion = moved.derivatives(1 / kPeriod_s);
    by_angle.push_back(kWheel.value(kInertia) * motion(0) + kWheel.value(kDamping) * motion(1));
  }
  const auto left = [](const std::vector<double>& response) {
    double power = 0;
    for (std::size_t k = 0; k < response.size(); ++k) {
      const double x = response[k] - (k >= 4 ? 0.4 * response[k - 4] : 0);
      power += x * x;
    }
    return power;
  };
  EXPECT_NEAR(left(torque), 0.051, 0.001);
  EXPECT_NEAR(left(by_angle), 166, 2);
}

}  // namespace
}  // namespace steerid
