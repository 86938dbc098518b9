// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The driver's state from parameters made by hand: every limit from both sides, and no state without a valid parameter.
#include <gtest/gtest.h>

#include "app/driver_state.hpp"

namespace steerid {
namespace {

constexpr auto kValid = ParameterState::kValid;

ParameterEstimate valid(double value, double sd) {
  return {static_cast<std::int32_t>(value * 1e6), static_cast<std::int32_t>(sd * 1e6), kValid};
}

/// Standard deviations of 1 %: the identifier's after some seconds of probe.
DriverEvidence arm(double inertia, double damping, double stiffness) {
  return {valid(inertia, 0.01 * inertia), valid(damping, 0.01 * damping), valid(stiffness, 0.01 * stiffness), 1000};
}

struct Told {
  DriverState state;
  HandCount hands;
};

Told after(DriverStateObserver& observer, const DriverEvidence& now, int times = 20) {
  for (int i = 0; i < times; ++i) observer.take(now);
  return {observer.state(now), observer.hands(now)};
}

DriverState fresh(const DriverEvidence& now) {
  DriverStateObserver observer;
  return after(observer, now).state;
}

// Nominal rows of tables I and II (Lv et al. 2018): the passive ones brace, the active ones do not.
TEST(DriverState, NamesThePapersNominalArms) {
  for (const DriverEvidence& passive : {arm(0.11, 1.5, 22.7), arm(0.11, 2.1, 45.9), arm(0.11, 0.7, 17.0)}) {
    EXPECT_EQ(fresh(passive), DriverState::kBraced);
  }
  for (const DriverEvidence& active : {arm(0.11, 2.9, 10.2), arm(0.11, 3.0, 9.2), arm(0.11, 3.1, 10.0)}) {
    EXPECT_EQ(fresh(active), DriverState::kRelaxed);
  }
  EXPECT_EQ(fresh(arm(0.03, 0.1, 1.0)), DriverState::kHandsOff);
}

TEST(DriverState, DecidesByStiffnessOutsideTheOverlapWhateverTheDamping) {
  EXPECT_EQ(fresh(arm(0.1, 4.0, 17.4)), DriverState::kBraced);   // 17.4 less 2 % is above 17
  EXPECT_EQ(fresh(arm(0.1, 0.5, 12.7)), DriverState::kRelaxed);  // 12.7 plus 2 % is below 13
}

TEST(DriverState, DecidesByTheRateInTheOverlap) {
  EXPECT_EQ(fresh(arm(0.1, 1.5, 15.0)), DriverState::kBraced);     // 10 /s
  EXPECT_EQ(fresh(arm(0.1, 2.5, 15.0)), DriverState::kRelaxed);    // 6 /s
  EXPECT_EQ(fresh(arm(0.1, 1.875, 15.0)), DriverState::kUnknown);  // 8 /s, between the limits
  DriverEvidence unexcited = arm(0.1, 1.5, 15.0);
  unexcited.damping.state = ParameterState::kNotExcited;
  EXPECT_EQ(fresh(unexcited), DriverState::kUnknown);
}

TEST(DriverState, KeepsItsStateBetweenTwoLimits) {
  const DriverEvidence between = arm(0.1, 1.875, 15.0);
  DriverStateObserver observer;
  EXPECT_EQ(after(observer, arm(0.1, 2.9, 10.0)).state, DriverState::kRelaxed);
  EXPECT_EQ(after(observer, between).state, DriverState::kRelaxed);
  EXPECT_EQ(after(observer, arm(0.1, 1.5, 30.0)).state, DriverState::kBraced);
  EXPECT_EQ(after(observer, between).state, DriverState::kBraced);
  EXPECT_EQ(after(observer, arm(0.1, 0.1, 1.0)).state, DriverState::kHandsOff);
  EXPECT_EQ(after(observer, arm(0.1, 0.1, 2.0)).state, DriverState::kHandsOff);  // 2 +- 0.04
  EXPECT_EQ(after(observer, between).state, DriverState::kUnknown);              // held again, and neither yet
}

// A finger adds 1 to 3 Nm/rad to a wheel: neither nobody nor an arm, whatever was told before.
TEST(DriverState, ALightTouchIsUnknown) {
  for (const double before : {1.0, 10.0, 30.0}) {
    DriverStateObserver observer;
    ASSERT_NE(after(observer, arm(0.1, 2.0, before)).state, DriverState::kUnknown);
    EXPECT_EQ(after(observer, arm(0.04, 0.3, 2.1)).state, DriverState::kUnknown) << "after " << before;
    ASSERT_NE(after(observer, arm(0.1, 2.0, before)).state, DriverState::kUnknown);
    EXPECT_EQ(after(observer, arm(0.04, 0.3, 3.9)).state, DriverState::kUnknown) << "after " << before;
  }
  EXPECT_EQ(fresh(arm(0.04, 0.3, 1.9)), DriverState::kHandsOff);
  EXPECT_EQ(fresh(arm(0.04, 0.3, 4.1)), DriverState::kRelaxed);
}

// Of a wheel without a spring C is never known to a tenth, and so never `valid`.
TEST(DriverState, AWheelWithoutASpringIsHandsOff) {
  DriverEvidence alone = arm(0.035, 0.08, 0.02);
  alone.stiffness = {20'000, 300'000, ParameterState::kNotExcited};
  EXPECT_EQ(fresh(alone), DriverState::kHandsOff);
  DriverEvidence unsure = alone;
  unsure.stiffness.sd_micro = 1'000'000;  // 0.02 and twice 1
  EXPECT_EQ(fresh(unsure), DriverState::kUnknown);
  DriverEvidence unexcited = alone;
  unexcited.inertia.state = ParameterState::kHolding;
  EXPECT_EQ(fresh(unexcited), DriverState::kUnknown);
  DriverEvidence at_rest = alone;
  at_rest.torque_mnm = 50;
  EXPECT_EQ(fresh(at_rest), DriverState::kUnknown);
}

TEST(DriverState, AnUncertainStiffnessTellsNothing) {
  DriverEvidence unsure = arm(0.1, 1.5, 18.0);
  unsure.damping.sd_micro = 1'000'000;
  unsure.stiffness.sd_micro = 600'000;  // 18.0 less twice 0.6 is not above 17
  EXPECT_EQ(fresh(unsure), DriverState::kUnknown);
  unsure.stiffness.sd_micro = 400'000;
  EXPECT_EQ(fresh(unsure), DriverState::kBraced);
}

TEST(DriverState, IsUnknownWhenTheStiffnessIsNotValid) {
  for (const ParameterState state : {ParameterState::kStarting, ParameterState::kConverging, ParameterState::kHolding,
                                     ParameterState::kFault, ParameterState::kNotExcited}) {
    DriverStateObserver observer;
    const DriverEvidence braced = arm(0.1, 1.5, 30.0);
    ASSERT_EQ(after(observer, braced).state, DriverState::kBraced);
    DriverEvidence lost = braced;
    lost.stiffness.state = state;
    EXPECT_EQ(observer.state(lost), DriverState::kUnknown);  // at once, before the next take()
    EXPECT_EQ(after(observer, lost, 1).state, DriverState::kUnknown);
    EXPECT_EQ(after(observer, braced, DriverStateObserver::kConfirm - 1).state, DriverState::kUnknown);
    EXPECT_EQ(after(observer, braced, 1).state, DriverState::kBraced);
  }
}

TEST(DriverState, IsUnknownWhileHardlyAnyTorqueActs) {
  DriverStateObserver observer;
  DriverEvidence braced = arm(0.1, 1.5, 30.0);
  ASSERT_EQ(after(observer, braced).state, DriverState::kBraced);
  braced.torque_mnm = 99;  // the limit is 100
  EXPECT_EQ(observer.state(braced), DriverState::kUnknown);
  EXPECT_EQ(after(observer, braced).state, DriverState::kUnknown);
  braced.torque_mnm = 100;
  EXPECT_EQ(after(observer, braced).state, DriverState::kBraced);
}

TEST(DriverState, HandsOffIsNotToldWhileTheDriversTorqueIsFelt) {
  DriverStateObserver observer;
  DriverEvidence off = arm(0.03, 0.1, 1.0);
  ASSERT_EQ(after(observer, off).state, DriverState::kHandsOff);
  off.torque_driver_mnm = 61;  // the limit is 60
  EXPECT_EQ(observer.state(off), DriverState::kUnknown);
  EXPECT_EQ(observer.hands(off), HandCount::kUnknown);
  EXPECT_EQ(after(observer, off).state, DriverState::kUnknown);
  off.torque_driver_mnm = 60;
  EXPECT_EQ(after(observer, off).state, DriverState::kHandsOff);
}

TEST(DriverState, AnUncertainInertiaCountsNoHands) {
  DriverStateObserver observer;
  after(observer, arm(0.11, 2.9, 10.0));
  DriverEvidence rough = arm(0.14, 3.3, 13.0);
  rough.inertia.sd_micro = 2800;  // 2 %
  EXPECT_EQ(after(observer, rough).hands, HandCount::kUnknown);
  rough.inertia.sd_micro = 2799;
  EXPECT_EQ(after(observer, rough).hands, HandCount::kTwo);
}

TEST(DriverState, ANewStateHasToBeSeenInARow) {
  DriverStateObserver observer;
  const DriverEvidence relaxed = arm(0.1, 2.9, 10.0);
  const DriverEvidence braced = arm(0.1, 1.5, 30.0);
  after(observer, relaxed);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(after(observer, braced, DriverStateObserver::kConfirm - 1).state, DriverState::kRelaxed);
    EXPECT_EQ(after(observer, relaxed, 1).state, DriverState::kRelaxed);
  }
}

TEST(DriverState, CountsHandsByTheDriversOwnInertia) {
  DriverStateObserver observer;
  EXPECT_EQ(after(observer, arm(0.11, 2.9, 10.0)).hands, HandCount::kUnknown);  // one or two, drivers differ
  EXPECT_EQ(after(observer, arm(0.1265, 3.3, 13.0)).hands, HandCount::kTwo);    // 15 % more
  EXPECT_EQ(after(observer, arm(0.1265, 3.3, 13.0), 500).hands, HandCount::kTwo);
  EXPECT_EQ(after(observer, arm(0.11, 2.9, 10.0)).hands, HandCount::kOne);
  EXPECT_EQ(after(observer, arm(0.115, 2.9, 10.0)).hands, HandCount::kOne);  // 5 %: a posture, not a hand
  EXPECT_EQ(after(observer, arm(0.03, 0.1, 1.0)).hands, HandCount::kNone);
  EXPECT_EQ(after(observer, arm(0.11, 2.9, 10.0)).hands, HandCount::kUnknown);  // hands came back, how many?
}

TEST(DriverState, CountsHandsWhereOnlyOneNumberIsPossible) {
  DriverStateObserver observer;
  EXPECT_EQ(after(observer, arm(0.19, 2.9, 10.0)).hands, HandCount::kTwo);
  DriverStateObserver other;
  EXPECT_EQ(after(other, arm(0.021, 2.9, 10.0)).hands, HandCount::kUnknown);  // one hand, or the wheel alone
}

TEST(DriverState, TheHandsAreForgottenWithTheInertia) {
  DriverStateObserver observer;
  DriverEvidence now = arm(0.19, 2.9, 10.0);
  ASSERT_EQ(after(observer, now).hands, HandCount::kTwo);
  now.inertia.state = ParameterState::kHolding;  // a held value is still this driver's
  EXPECT_EQ(after(observer, now).hands, HandCount::kTwo);
  now.inertia.state = ParameterState::kFault;
  EXPECT_EQ(observer.hands(now), HandCount::kUnknown);
  EXPECT_EQ(after(observer, now, 1).hands, HandCount::kUnknown);
  now = arm(0.11, 2.9, 10.0);
  EXPECT_EQ(after(observer, now).hands, HandCount::kUnknown);
}

TEST(DriverState, HoldsAtTheEndsOfTheIntegers) {
  DriverEvidence now;
  now.torque_mnm = INT32_MAX;
  now.inertia = now.damping = now.stiffness = {INT32_MAX, INT32_MAX, kValid};
  EXPECT_EQ(fresh(now), DriverState::kUnknown);
  now.inertia = now.damping = now.stiffness = {INT32_MIN, 0, kValid};
  EXPECT_EQ(fresh(now), DriverState::kHandsOff);
  now.damping = now.stiffness = {INT32_MAX, 0, kValid};
  EXPECT_EQ(fresh(now), DriverState::kBraced);
}

// Above a torsion bar the identifier's own word that nobody holds the wheel counts whatever is valid: no less than 0.99
// of it, for a second.
TEST(DriverState, HandsOffIsToldByTheProbabilityOfAReleasedWheel) {
  DriverStateObserver observer;
  DriverEvidence unexcited;
  unexcited.above_bar = true;
  unexcited.released_micro = 990'000;
  for (int k = 0; k < 20; ++k) observer.take(unexcited);
  EXPECT_EQ(observer.state(unexcited), DriverState::kUnknown);
  unexcited.released_micro = 990'001;
  for (int k = 0; k < 9; ++k) observer.take(unexcited);
  EXPECT_EQ(observer.state(unexcited), DriverState::kUnknown);  // ten have to agree
  observer.take(unexcited);
  EXPECT_EQ(observer.state(unexcited), DriverState::kHandsOff);
  EXPECT_EQ(observer.hands(unexcited), HandCount::kNone);
  // Until somebody is as likely as nobody.
  unexcited.released_micro = 500'001;
  for (int k = 0; k < 20; ++k) observer.take(unexcited);
  EXPECT_EQ(observer.state(unexcited), DriverState::kHandsOff);
  unexcited.released_micro = 500'000;  // at once, before the next take()
  EXPECT_EQ(observer.state(unexcited), DriverState::kUnknown);
}

// A spring that is small says as little of hands there as it does of fingers.
TEST(DriverState, AboveATorsionBarASmallSpringAloneIsNoRelease) {
  DriverEvidence soft = arm(0.04, 0.1, 0.5);
  EXPECT_EQ(fresh(soft), DriverState::kHandsOff);
  soft.above_bar = true;
  EXPECT_EQ(fresh(soft), DriverState::kUnknown);
}

}  // namespace
}  // namespace steerid
