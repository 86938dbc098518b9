// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The score of the driver's state on stretches made by hand, and the firmware on one take-over drive.
#include <gtest/gtest.h>

#include "reproduction/driver_state_score.hpp"
#include "reproduction/identified_record.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

TEST(DriverStateScore, CountsSecondsAndFindsTheInstant) {
  const WheelArm braced = nominal_arm(TaskKind::kPassive, HandPosition::kRight3);
  const WheelArm relaxed = nominal_arm(TaskKind::kActive, HandPosition::kRight3);
  const std::vector<Stretch> truth{{0, 10, DriverState::kBraced, HandCount::kOne, braced},
                                   {10, 20, DriverState::kRelaxed, HandCount::kTwo, relaxed}};
  std::vector<Estimate> told(2000);
  // Braced told from 2.0 s on, a wrong glimpse of half a second at 7 s, relaxed told from 13 s on.
  for (std::size_t i = 200; i < 1000; ++i) told[i].driver = DriverState::kBraced;
  for (std::size_t i = 700; i < 750; ++i) told[i].driver = DriverState::kRelaxed;
  for (std::size_t i = 1300; i < 2000; ++i) told[i].driver = DriverState::kRelaxed;
  for (std::size_t i = 1500; i < 2000; ++i) told[i].hands = HandCount::kTwo;
  DriverStateScore score;
  score_drive(truth, told, score);
  constexpr auto kB = static_cast<std::size_t>(DriverState::kBraced);
  constexpr auto kR = static_cast<std::size_t>(DriverState::kRelaxed);
  EXPECT_NEAR(score.state[kB][0], 2.0, 1e-9);
  EXPECT_NEAR(score.state[kB][kB], 7.5, 1e-9);
  EXPECT_NEAR(score.state[kB][kR], 0.5, 1e-9);
  EXPECT_NEAR(score.state[kR][0], 3.0, 1e-9);
  EXPECT_NEAR(score.state[kR][kR], 7.0, 1e-9);
  EXPECT_NEAR(score.state_settled[kB][kB], 4.5, 1e-9);
  EXPECT_NEAR(score.state_settled[kR][kR], 5.0, 1e-9);
  EXPECT_NEAR(score.wrong_share(score.state), 0.5 / 15, 1e-9);
  EXPECT_NEAR(score.told_share(score.state), 15.0 / 20, 1e-9);
  EXPECT_NEAR(score.hands[static_cast<std::size_t>(HandCount::kTwo)][3], 5.0, 1e-9);
  EXPECT_EQ(score.overlapping_s, 0);
  ASSERT_EQ(score.detections.size(), 2U);
  EXPECT_NEAR(score.detections[0].after_s.value_or(-1), 2.0, 1e-9);
  EXPECT_NEAR(score.detections[1].after_s.value_or(-1), 3.0, 1e-9);
}

TEST(DriverStateScore, AnArmOfAnotherStateIsTheTablesFault) {
  // 13 Nm/rad and 3.1 Nms/rad are in table I; at 4.2 /s they are an arm that steers by every nominal row.
  EXPECT_EQ(state_of_exact({0.11, 3.1, 13.5}), DriverState::kRelaxed);
  EXPECT_EQ(state_of_exact(kWheelAlone), DriverState::kHandsOff);
}

TEST(TakeOverDrive, TheFirmwareTellsEveryStretchAndNeverFromWhatIsNotValid) {
  VirtualSubject nominal;
  for (const HandPosition hands : kAllHandPositions) {
    nominal.passive[static_cast<std::size_t>(hands)] = nominal_arm(TaskKind::kPassive, hands);
    nominal.active[static_cast<std::size_t>(hands)] = nominal_arm(TaskKind::kActive, hands);
  }
  TakeOverSettings settings;
  settings.seed = test::seed(91);
  const TakeOverDrive drive = make_take_over_drive(nominal, settings);
  ASSERT_EQ(drive.record.size(), 17000U);
  const std::vector<Estimate> told = firmware_estimates(drive.record);
  for (const Estimate& estimate : told) {
    if (estimate.driver == DriverState::kUnknown) continue;
    // A wheel without a spring has a stiffness of about zero, of which no share is known.
    const bool known = estimate.stiffness.state == ParameterState::kValid ||
                       (estimate.driver == DriverState::kHandsOff && estimate.inertia.state == ParameterState::kValid);
    ASSERT_TRUE(known);
  }
  int right = 0;
  for (const Stretch& stretch : drive.truth) {
    // Two seconds before the end: in the last one the driver's torque fades.
    const Estimate& last = told[static_cast<std::size_t>(stretch.to_s * 100) - 200];
    right += last.driver == stretch.state ? 1 : 0;
    const bool wrong = last.driver != DriverState::kUnknown && last.driver != stretch.state;
    EXPECT_FALSE(wrong) << name(stretch.state) << " from " << stretch.from_s << " s, told " << name(last.driver);
    const bool contradicts = last.hands != HandCount::kUnknown && last.hands != stretch.hands;
    EXPECT_FALSE(contradicts) << "hands told " << name(last.hands) << " at " << stretch.to_s << " s";
  }
  EXPECT_GE(right, 5);  // of six
}

}  // namespace
}  // namespace steerid
