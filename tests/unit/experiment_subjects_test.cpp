// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Virtual subjects and the forces of their hands: ranges, dependences, and moments in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/grasp.hpp"
#include "experiment/virtual_subject.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr std::size_t kMany = 2000;

TEST(VirtualSubject, ReachesNominalAndEnds) {
  const PublishedRange range{2.0, 1.0, 8.0};
  EXPECT_DOUBLE_EQ(value_at(range, 0), 2.0);
  EXPECT_NEAR(value_at(range, 1.5388), 8.0, 1e-12);
  EXPECT_NEAR(value_at(range, -1.5388), 1.0, 1e-12);
  EXPECT_NEAR(value_at(range, 1.5388 / 2), 4.0, 1e-12);  // half way on a logarithmic scale
  EXPECT_EQ(value_at(range, 9), value_at(range, 2));
}

TEST(VirtualSubject, StaysInsideThePrintedRanges) {
  for (const VirtualSubject& subject : virtual_subjects(test::seed(61), kMany)) {
    for (const TaskKind task : {TaskKind::kPassive, TaskKind::kActive}) {
      for (std::size_t at = 0; at < 3; ++at) {
        const WheelArm& arm = subject.arm(task, kAllHandPositions[at]);
        const PublishedRow& row = published_row(task, kAllHandPositions[at]);
        const auto inside = [](double value, const PublishedRange& range) {
          return value >= range.low * (1 - 1e-12) && value <= range.high * (1 + 1e-12);
        };
        ASSERT_TRUE(inside(arm.damping_nms_per_rad, row.damping_nms_per_rad));
        ASSERT_TRUE(inside(arm.stiffness_nm_per_rad, row.stiffness_nm_per_rad));
        ASSERT_GE(arm.inertia_kgm2, 0.02 - 1e-12);  // both tables together
        ASSERT_LE(arm.inertia_kgm2, 0.18 + 1e-12);
      }
    }
  }
}

TEST(VirtualSubject, HasOneInertiaForBothTasksAndMoreWithBothArms) {
  for (const VirtualSubject& subject : virtual_subjects(test::seed(62), 50)) {
    for (std::size_t at = 0; at < 6; ++at) {
      EXPECT_EQ(subject.passive[at].inertia_kgm2, subject.active[at].inertia_kgm2);
      EXPECT_NEAR(subject.passive[at].inertia_kgm2 / subject.passive[at % 3].inertia_kgm2, at < 3 ? 1.0 : 1.15, 1e-12);
    }
  }
}

// Medians of 2000 draws: standard error of a median 1.25/sqrt(2000) = 0.028 z, which moves the widest range
// (0.1 to 1.5 to 2.5) by less than 5 %.
TEST(VirtualSubject, HasThePrintedNominalValuesInTheMiddle) {
  const auto subjects = virtual_subjects(test::seed(63), kMany);
  for (const PublishedRow& row : kPublishedRows) {
    std::vector<double> stiffness;
    std::vector<double> damping;
    for (const VirtualSubject& subject : subjects) {
      stiffness.push_back(subject.arm(row.task, row.hands).stiffness_nm_per_rad);
      damping.push_back(subject.arm(row.task, row.hands).damping_nms_per_rad);
    }
    const auto median = [](std::vector<double>& values) {
      std::nth_element(values.begin(), values.begin() + kMany / 2, values.end());
      return values[kMany / 2];
    };
    EXPECT_NEAR(median(stiffness) / row.stiffness_nm_per_rad.nominal, 1, 0.05);
    EXPECT_NEAR(median(damping) / row.damping_nms_per_rad.nominal, 1, 0.1);
  }
}

TEST(VirtualSubject, IsTheSameForTheSameSeed) {
  const auto once = virtual_subjects(5);
  const auto again = virtual_subjects(5);
  const auto other = virtual_subjects(6);
  EXPECT_EQ(once[3].passive[2].stiffness_nm_per_rad, again[3].passive[2].stiffness_nm_per_rad);
  EXPECT_NE(once[3].passive[2].stiffness_nm_per_rad, other[3].passive[2].stiffness_nm_per_rad);
}

// At 3 o'clock and rest the rim runs forward: M = R F_y, and the pull towards the hub is all in x (figure 3a).
TEST(Grasp, AtThreeOClockTheMomentIsTheForwardForce) {
  Grasp grasp(HandPosition::kRight3, test::seed(64), 0);
  grasp.next();
  const auto forces = grasp.at(0.003, 1.9, 0.0);
  EXPECT_NEAR(forces[0].y_n, 1.9 / 0.19, 1e-12);
  EXPECT_LT(forces[0].x_n, 0);  // towards the hub, which is to the left
}

// Figure 3b: at 9 o'clock counter-clockwise is backwards.
TEST(Grasp, AtNineOClockTheRimRunsTheOtherWay) {
  const std::array<GraspForce, 2> forces{GraspForce{0, 5}, GraspForce{0, -7}};
  EXPECT_NEAR(grasp_moment_nm(HandPosition::kBoth3And9, forces, 0), 0.19 * 12, 1e-12);
}

// The cross product r x F, with the hand's place worked out from the clock: 12 hours a turn, clockwise from the top.
TEST(Grasp, MomentIsTheCrossProductAtEveryPosition) {
  const std::array<std::array<double, 2>, 6> hours{{{3, -1}, {12, -1}, {1.5, -1}, {3, 9}, {12, 6}, {2, 10}}};
  for (std::size_t at = 0; at < 6; ++at) {
    const double turned = 0.7;
    const std::array<GraspForce, 2> forces{GraspForce{3, -4}, GraspForce{-2, 6}};
    double expected = 0;
    for (std::size_t hand = 0; hand < 2; ++hand) {
      if (hours[at][hand] < 0) continue;
      const double clockwise = hours[at][hand] / 12 * 2 * M_PI - turned;
      const double x = 0.19 * std::sin(clockwise);
      const double y = 0.19 * std::cos(clockwise);
      expected += x * forces[hand].y_n - y * forces[hand].x_n;
    }
    EXPECT_NEAR(grasp_moment_nm(kAllHandPositions[at], forces, turned), expected, 1e-12) << at;
  }
}

TEST(Grasp, MakesTheDriversTorqueWhateverTheHandsDoBesides) {
  for (const HandPosition hands : kAllHandPositions) {
    Grasp grasp(hands, test::seed(65), 0);
    double pulled = 0;
    for (int tick = 0; tick < 1000; ++tick) {
      grasp.next();
      const double torque = 10 * std::sin(0.02 * tick);
      const double angle = std::cos(0.013 * tick);
      const auto forces = grasp.at(0.004, torque, angle);
      ASSERT_NEAR(grasp_moment_nm(hands, forces, angle), torque, 1e-11);
      pulled = std::max(pulled, std::hypot(forces[0].x_n, forces[0].y_n) - std::abs(torque) / 0.19);
    }
    EXPECT_GT(pulled, 1.0);  // there is more in the forces than the torque
  }
}

}  // namespace
}  // namespace steerid
