// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A wheel that a position loop holds: its rest in closed form, and noise that it answers.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "blind/drawn_case.hpp"
#include "blind/linear_refit.hpp"
#include "blind/position_loop.hpp"
#include "support/seed.hpp"

namespace steerid::blind {
namespace {

constexpr Arm kArm{0.1, 1.0, 8.0};
constexpr Run kRun{.lead_in_s = 4, .duration_s = 20};
constexpr Sensors kIdeal{};

PositionLoop resting(double reference_rad) {
  PositionLoop loop;
  loop.reference_rad = Signal([=](double) { return reference_rad; }, -6, 22);
  loop.damping_nms_per_rad = 4;
  loop.stiffness_nm_per_rad = 90;
  loop.late_ms = 4;
  return loop;
}

Record held(const PositionLoop& loop) {
  Elements elements;
  elements.push_back(held_by(loop, kRun));
  return simulate(kArm, {}, elements, kIdeal, kRun, 1).record;
}

TEST(BlindPositionLoop, RestsWhereSpringAndLoopBalance) {
  const Record record = held(resting(0.3));
  // C theta = P (r - theta). The slowest root of J s^2 + (B + D) s + C + P is 25 /s: gone after 4 s.
  const double angle = 0.3 * 90 / (90 + 8.0);
  EXPECT_NEAR(record.angle_rad.back(), angle, 1e-6);
  EXPECT_NEAR(record.torque_motor_nm.back(), -8.0 * angle, 1e-5);
  EXPECT_EQ(record.torque_driver_nm.back(), 0);
}

TEST(BlindPositionLoop, AnswersTheNoiseOfItsAngle) {
  PositionLoop loop = resting(0);
  const Record quiet = held(loop);
  for (const double torque : quiet.torque_motor_nm) EXPECT_NEAR(torque, 0, 1e-12);
  loop.noise_rad = 1e-3;
  loop.seed = test::seed(21);
  const Record noisy = held(loop);
  double torque = 0;
  double angle = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    torque += std::pow(noisy.torque_motor_nm[i], 2) / static_cast<double>(noisy.size());
    angle += std::pow(noisy.angle_rad[i], 2) / static_cast<double>(noisy.size());
  }
  // White noise of 1 kHz through 40 Hz has 2 * 40 * 1.11 / 1000 of its power; the wheel itself adds what it is pushed.
  EXPECT_NEAR(std::sqrt(angle), 1e-3 * std::sqrt(0.089), 0.25e-3 * std::sqrt(0.089));
  // D w^2 integrated to the filter's corner: between P alone and D at 40 Hz on all of it.
  EXPECT_GT(std::sqrt(torque), 90 * 1e-3 * std::sqrt(0.089));
  EXPECT_LT(std::sqrt(torque), 4 * 2 * 3.1416 * 40 * 1e-3 * std::sqrt(0.089));
}

TEST(BlindPositionLoop, ADrawnOneFollowsItsReference) {
  Draw draw(test::seed(22));
  const PositionLoop loop = draw_position_loop(kArm, kRun, 1, draw);
  const Record record = held(loop);
  double error = 0;
  double reference = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double wanted = loop.reference_rad.at(record.time_s[i]);
    error += std::pow(record.angle_rad[i] - wanted, 2);
    reference += wanted * wanted;
  }
  // Most of the reference is below 1 Hz, where loops that cross over at 4 Hz and more leave a third at the worst.
  EXPECT_LT(error, 0.35 * 0.35 * reference);
  EXPECT_GT(error, 1e-4 * reference);
}

TEST(BlindPositionLoop, ADrawnCaseIsHeldAndStillTheSameWheel) {
  const DrawnCase drawn = draw_case({"none"}, test::seed(23), true);
  EXPECT_EQ(drawn.task, Task::kLoop);
  EXPECT_EQ(name(drawn.task), "loop");
  // What is fitted leans towards the loop by the noise's share of the motion, which is small where it is driven.
  EXPECT_NEAR(drawn.linear_fit.inertia_kgm2, drawn.arm.inertia_kgm2, 0.05 * drawn.arm.inertia_kgm2);
  EXPECT_NEAR(drawn.linear_fit.stiffness_nm_per_rad, drawn.arm.stiffness_nm_per_rad,
              0.05 * drawn.arm.stiffness_nm_per_rad);
  const DrawnCase again = draw_case({"none"}, test::seed(23), true);
  EXPECT_EQ(again.record.angle_rad, drawn.record.angle_rad);
  EXPECT_NE(draw_case({"none"}, test::seed(23)).task, Task::kLoop);
}

}  // namespace
}  // namespace steerid::blind
