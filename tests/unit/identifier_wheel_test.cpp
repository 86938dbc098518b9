// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Both identifiers side by side, on a wheel of the tests' own whose stiffness may be another one at any time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "identifier/wheel_identifier.hpp"
#include "support/seed.hpp"
#include "support/steady_wheel.hpp"

namespace steerid {
namespace {

/// J th'' + B th' + C(t) th = T in 50 small steps a sample, read with a production wheel's noise.
class ChangingWheel {
 public:
  explicit ChangingWheel(std::uint64_t seed) : random_(seed) {
    probe_.tones = test::SteadyWheel::probe();
    // Schroeder's phases sweep, and while the sweep is high C does not show.
    std::uniform_real_distribution<double> phase(0, 6.28);
    for (test::Tone& tone : probe_.tones) tone.phase_rad = phase(random_);
  }

  double inertia = 0.11, damping = 1.5, stiffness = 22.7;
  double drive = 1;  ///< of the probe's torque

  WheelSample<double> next() {
    const double torque = drive * probe_.torque_nm(t_s_);
    const WheelSample<double> sample = {torque + 0.03 * normal_(random_), angle_ + 0.0007 * normal_(random_), 0};
    constexpr int kSteps = 50;
    for (int i = 0; i < kSteps; ++i) {
      const double h = 0.01 / kSteps;
      rate_ += h * (drive * probe_.torque_nm(t_s_) - damping * rate_ - stiffness * angle_) / inertia;
      angle_ += h * rate_;
      t_s_ += h;
    }
    return sample;
  }

 private:
  test::SteadyWheel probe_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double t_s_ = 0, angle_ = 0, rate_ = 0;
};

struct Told {
  int ticks = 0, valid = 0, wrong = 0, followed = 0;
};

/// C goes to `to` within `within_s`, B with it as its root, and stays for `after_s`.
Told told_of_c(WheelIdentifier<double>& identifier, ChangingWheel& wheel, double to, double within_s, double after_s) {
  Told told;
  const double from = wheel.stiffness;
  for (int k = 0; k < static_cast<int>(100 * (within_s + after_s)); ++k) {
    wheel.stiffness = 0.01 * k < within_s ? from + (to - from) * 0.01 * k / within_s : to;
    wheel.damping = 1.5 * std::sqrt(wheel.stiffness / 22.7);
    identifier.update(wheel.next());
    ++told.ticks;
    told.followed += identifier.follows(kStiffness);
    if (identifier.belief(kStiffness) != Belief::kValid) continue;
    ++told.valid;
    const double off = std::abs(identifier.value(kStiffness) - wheel.stiffness);
    told.wrong += off > 1.96 * identifier.standard_deviation()(kStiffness) && off > 0.1 * wheel.stiffness;
  }
  return told;
}

// The steady identifier alone has C valid and wrong on 40 to 90 % of such ticks (docs/testing.md). Of seven seeds the
// worst has 4.7 %, half a second after the fastest change.
TEST(WheelIdentifier, FollowsAnArmThatStiffensAndThenGoesOnAsSteadyAsBefore) {
  for (const double within_s : {0.3, 5.0, 20.0}) {
    WheelIdentifier<double> identifier;
    ChangingWheel wheel(test::seed(31));
    EXPECT_EQ(told_of_c(identifier, wheel, 22.7, 1, 19).wrong, 0);
    EXPECT_LT(identifier.changed(), 0.1);
    const Told told = told_of_c(identifier, wheel, 45.4, within_s, 15);
    EXPECT_LE(told.wrong, 0.06 * told.valid) << within_s << " s";
    EXPECT_GE(told.valid, 0.6 * told.ticks) << within_s;
    EXPECT_GE(told.followed, 25) << within_s;
    EXPECT_NEAR(identifier.value(kStiffness) / 45.4, 1, 0.03) << within_s;
    EXPECT_NEAR(identifier.value(kInertia) / 0.11, 1, 0.03) << within_s;
    told_of_c(identifier, wheel, 45.4, 1, 19);
    EXPECT_FALSE(identifier.follows(kStiffness));
    EXPECT_NEAR(identifier.value(kStiffness) / 45.4, 1, 0.01);
    EXPECT_TRUE(identifier.sound());
  }
}

/// What a normal distribution has outside of +- half around `off` from its mean, in its deviations.
double outside(double off, double half) {
  return 0.5 * std::erfc((half - off) / std::sqrt(2.0)) + 0.5 * std::erfc((half + off) / std::sqrt(2.0));
}

// Of an arm that stays the steady value is known far better than what the last seconds alone could exclude. Oracle: the
// mixture of both normal distributions, a change ten times as likely beforehand as for the answer. Of seven seeds the
// interval leaves out 0.3 to 0.8 % of it, and is 0.95 to 1.05 times both intervals and their distance in a row.
TEST(WheelIdentifier, HoldsInItsIntervalWhatTheLastSecondsCannotExclude) {
  WheelIdentifier<double> identifier;
  ChangingWheel wheel(test::seed(36));
  told_of_c(identifier, wheel, 22.7, 1, 29);
  const double odds = 10 * identifier.changed() / (1 - identifier.changed());
  const double other = odds / (1 + odds);
  for (int i = 0; i < 3; ++i) {
    ASSERT_FALSE(identifier.follows(i));
    const double half = 1.96 * identifier.standard_deviation()(i);
    const double steady = identifier.steady().standard_deviation()(i);
    const double follower = identifier.follower().standard_deviation()(i);
    const double off = std::abs(identifier.follower().value(i) - identifier.steady().value(i));
    EXPECT_LE((1 - other) * outside(0, half / steady) + other * outside(off / follower, half / follower), 0.05) << i;
    EXPECT_LE(half, 1.2 * (off + 1.96 * follower + 1.96 * steady)) << i;
    EXPECT_EQ(identifier.deviation_of_answer(i), steady);
  }
}

// The steady identifier has an arm after 1.8 s and is sure of one after 3.8 s at the earliest; the follower has filters
// to fill for 0.5 s, noise to learn for 1.2 s and an arm for 1 s.
TEST(WheelIdentifier, FollowsFromTheFirstArmOn) {
  WheelIdentifier<double> identifier;
  ChangingWheel wheel(test::seed(37));
  told_of_c(identifier, wheel, 22.7, 1, 0.7);
  EXPECT_FALSE(identifier.follower().learns());
  told_of_c(identifier, wheel, 22.7, 1, 1.9);
  EXPECT_TRUE(identifier.follower().learns());
  told_of_c(identifier, wheel, 22.7, 0.1, 0.1);
  EXPECT_NE(identifier.follower().belief(kStiffness), Belief::kStarting);
}

// To the steady identifier a large change is like a sensor at fault, and on six of ten such wheels it searches from the
// prior within the minute. The follower, begun anew, would not learn for 1.7 s.
TEST(WheelIdentifier, GoesOnFollowingWhereTheFollowerKnowsTheArmThatTheSteadyOneHasLost) {
  int searched = 0;
  for (std::uint64_t number = 0; number < 10 && searched == 0; ++number) {
    WheelIdentifier<double> identifier;
    ChangingWheel wheel(test::seed(38) + number);
    told_of_c(identifier, wheel, 22.7, 1, 19);
    for (int k = 0; k < 6000; ++k) {
      wheel.stiffness = 22.7 * std::pow(4, std::sin(2 * 3.14159265 * k / 800));  // by 4 up and down within 8 s
      wheel.damping = 1.5 * std::sqrt(wheel.stiffness / 22.7);
      identifier.update(wheel.next());
      if (identifier.steady().phase() != Phase::kSearching) continue;
      ++searched;
      EXPECT_TRUE(identifier.follower().learns()) << k;
    }
  }
  EXPECT_GT(searched, 0);
}

// What is not shown does not change, whatever the follower makes of noise; 0.1 % is what the steady identifier drifts
// by.
TEST(WheelIdentifier, KeepsAtRestWhatItKnew) {
  WheelIdentifier<double> identifier;
  ChangingWheel wheel(test::seed(32));
  told_of_c(identifier, wheel, 22.7, 1, 19);
  const Vector3<double> before = identifier.value();
  wheel.drive = 0;
  const Told told = told_of_c(identifier, wheel, 22.7, 1, 119);
  EXPECT_EQ(told.followed, 0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(identifier.value(i) / before(i), 1, 5e-3);
}

TEST(WheelIdentifier, ForgetsWhatTheFollowerLearnedByAnotherTorque) {
  WheelIdentifier<double> identifier;
  ChangingWheel wheel(test::seed(33));
  told_of_c(identifier, wheel, 22.7, 1, 19);
  identifier.voluntary_torque_known(true);  // as before: nothing happens
  EXPECT_NEAR(identifier.follower().value(kStiffness) / 22.7, 1, 0.1);
  identifier.voluntary_torque_known(false);
  EXPECT_EQ(identifier.changed(), 1);
  EXPECT_TRUE(identifier.follows(kInertia));
  EXPECT_EQ(identifier.belief(kStiffness), Belief::kStarting);
  EXPECT_EQ(identifier.standard_deviation()(kStiffness), identifier.follower().standard_deviation()(kStiffness));
  EXPECT_EQ(identifier.deviation_of_answer(kInertia), identifier.follower().standard_deviation()(kInertia));
  identifier.voluntary_torque_known(true);
  EXPECT_NEAR(identifier.value(kStiffness) / 22.7, 1, 0.02);  // what the steady one has learned stays
  identifier.restart();
  EXPECT_EQ(identifier.belief(kStiffness), Belief::kStarting);
}

TEST(Identifier, SaysItsPhase) {
  Identifier<double> identifier;
  ChangingWheel wheel(test::seed(34));
  const auto run = [&](int samples) {
    for (int k = 0; k < samples; ++k) {
      const WheelSample<double> sample = wheel.next();
      identifier.update(sample.torque_nm, sample.angle_rad);
    }
    return identifier.phase();
  };
  EXPECT_EQ(identifier.phase(), Phase::kSettling);
  EXPECT_EQ(run(29), Phase::kSettling);
  EXPECT_EQ(run(2), Phase::kSearching);
  EXPECT_EQ(run(160), Phase::kRefining);
  EXPECT_EQ(run(2000), Phase::kWatching);
  wheel.inertia = 0.3;
  wheel.damping = 5;
  wheel.stiffness = 120;
  bool another = false;
  for (int k = 0; k < 100; ++k) another = another || run(1) == Phase::kSearchingAnother;
  EXPECT_TRUE(another);
}

}  // namespace
}  // namespace steerid
