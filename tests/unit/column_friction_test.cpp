// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction of the column, above its torsion bar and below: it really holds, a wheel with friction moves as in
// closed form, and both stick and slip as by an integrator that takes friction as impulses.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "column_inputs.hpp"
#include "plant/column_plant.hpp"
#include "plant_drive.hpp"
#include "support/steered_column.hpp"

namespace steerid::test {
namespace {

TEST(ColumnPlant, FrictionHoldsToTheLastBit) {
  ColumnPlant plant{Column{}};
  plant.start({});
  // 0.2 Nm of probe and road are less than 0.75 Nm of friction.
  const Torque weak{{{0.2, 3.0, 0.3}}};
  for (int i = 0; i < 200; ++i) plant.advance(inputs(kArm, {}, weak, weak, i * kTickS), kTickS);
  EXPECT_EQ(plant.state().column_angle_rad, 0.0);
  EXPECT_EQ(plant.state().column_rate_rad_s, 0.0);
  EXPECT_TRUE(plant.column_held());
  // A driver who pushes hard turns it, and where he lets go it stays: neither spring overcomes the friction there.
  Column free_of_tyres;
  free_of_tyres.aligning_stiffness_nm_per_rad = 0;
  ColumnPlant pushed(free_of_tyres);
  pushed.start({});
  const WheelArm wheel{0.034, 0.055, 0};
  ColumnInputs push = inputs(wheel, {}, {}, {}, 0);
  push.voluntary_nm.c0 = 3;
  pushed.advance(push, 0.5);
  EXPECT_GT(pushed.state().column_angle_rad, 0.1);
  EXPECT_FALSE(pushed.column_held());
  push.voluntary_nm.c0 = 0;
  for (int i = 0; i < 1000; ++i) pushed.advance(push, kTickS);
  ASSERT_TRUE(pushed.column_held());
  const double rests_at = pushed.state().column_angle_rad;
  for (int i = 0; i < 100; ++i) pushed.advance(push, kTickS);
  EXPECT_EQ(pushed.state().column_angle_rad, rests_at);
}

/// A column that nothing turns, and a bar without damping: above it remain J, C + kt and the wheel's friction.
Column locked_column(double wheel_friction_nm) {
  Column column;
  column.wheel_friction_nm = wheel_friction_nm;
  column.bar_damping_nms_per_rad = 0;
  column.assist_gain = 0;
  column.rack_friction_nm = 20;
  return column;
}

/// Under a torque r t it stands until r t = F. From there, for one swing, with w^2 = k / J and s = t - F / r:
///   th = r / k (s - sin(w s) / w)
TEST(ColumnPlant, AWheelBreaksLooseWhereTheTorquePassesItsFriction) {
  const Column column = locked_column(0.6);
  constexpr double kRise = 1.5;  // Nm/s
  constexpr double kH = 1e-3;
  const WheelArm arm{0.11, 0, 22.7};
  const double k = arm.stiffness_nm_per_rad + column.bar_stiffness_nm_per_rad;
  const double w = std::sqrt(k / arm.inertia_kgm2);
  const double loose_s = column.wheel_friction_nm / kRise;
  ColumnPlant plant(column);
  plant.start({});
  for (int i = 0; i * kH < loose_s + 0.9 * kTwoPi / w; ++i) {
    const double t = i * kH;
    ColumnInputs now = inputs(arm, {}, {}, {}, t);
    now.voluntary_nm = {kRise * t, kRise, 0, 0};
    const ColumnTorques torques = plant.torques(now);
    const double s = std::max(0.0, t - loose_s);
    const double angle = kRise / k * (s - std::sin(w * s) / w);
    // The hand: Tv less what the arm takes. The wheel's friction is no part of it.
    const double hand = kRise * t - arm.stiffness_nm_per_rad * angle -
                        (arm.inertia_kgm2 - column.wheel_inertia_kgm2) * kRise / k * w * std::sin(w * s) +
                        column.wheel_damping_nms_per_rad * kRise / k * (1 - std::cos(w * s));
    ASSERT_NEAR(torques.rim_nm, hand, 1e-7) << t;
    if (t < loose_s) {
      ASSERT_EQ(plant.state().angle_rad, 0) << t;
      ASSERT_TRUE(plant.wheel_held()) << t;
      ASSERT_DOUBLE_EQ(torques.wheel_friction_nm, kRise * t);
    } else {
      ASSERT_NEAR(plant.state().angle_rad, angle, 1e-9) << t;
      ASSERT_DOUBLE_EQ(torques.wheel_friction_nm, column.wheel_friction_nm);
    }
    plant.advance(now, kH);
  }
  EXPECT_FALSE(plant.wheel_held());
  EXPECT_TRUE(plant.column_held());
}

/// Let go at x0 it swings with its own period, 2 F / k less to every side, and rests where the springs no longer
/// overcome the friction.
TEST(ColumnPlant, ASwingOnTheBarLosesFourFrictionsOverItsStiffnessACycle) {
  const Column column = locked_column(0.6);
  const WheelArm arm{0.11, 0, 22.7};
  const double k = arm.stiffness_nm_per_rad + column.bar_stiffness_nm_per_rad;
  const double lost = 2 * column.wheel_friction_nm / k;
  constexpr int kSwings = 14;
  const double from = (kSwings + 0.3) * lost;  // 0.3 of it is left: less than the half that friction holds
  ColumnPlant plant(column);
  plant.start({.angle_rad = from});
  const ColumnInputs none = inputs(arm, {}, {}, {}, 0);
  const double half_period_s = kTwoPi / 2 * std::sqrt(arm.inertia_kgm2 / k);
  for (int i = 1; i <= kSwings; ++i) {
    plant.advance(none, half_period_s);
    const double way = i % 2 == 0 ? 1 : -1;
    EXPECT_NEAR(plant.state().angle_rad, way * (from - i * lost), 1e-6) << i;
    EXPECT_NEAR(plant.state().rate_rad_s, 0, 2e-4) << i;
  }
  plant.advance(none, half_period_s);
  ASSERT_TRUE(plant.wheel_held());
  const double rests_at = plant.state().angle_rad;
  for (int i = 0; i < 100; ++i) plant.advance(none, kTickS);
  EXPECT_EQ(plant.state().angle_rad, rests_at);
  EXPECT_NEAR(plant.torques(none).wheel_friction_nm, -k * rests_at, 1e-12);
}

/// Set in motion at the middle it is braked from there on: th = v / w sin(w t) - F / k (1 - cos(w t)) up to its turn.
TEST(ColumnPlant, AWheelThatStartsInMotionIsBraked) {
  const Column column = locked_column(0.6);
  const WheelArm arm{0.11, 0, 22.7};
  const double k = arm.stiffness_nm_per_rad + column.bar_stiffness_nm_per_rad;
  const double w = std::sqrt(k / arm.inertia_kgm2);
  const ColumnInputs none = inputs(arm, {}, {}, {}, 0);
  for (const double way : {1.0, -1.0}) {
    constexpr double kRate = 0.8;  // rad/s
    ColumnPlant plant(column);
    plant.start({.rate_rad_s = way * kRate});
    plant.advance(none, kTickS);
    const double swung = w * kTickS;
    const double angle = kRate / w * std::sin(swung) - column.wheel_friction_nm / k * (1 - std::cos(swung));
    EXPECT_NEAR(plant.state().angle_rad, way * angle, 1e-8);
    EXPECT_EQ(plant.torques(none).wheel_friction_nm, way * column.wheel_friction_nm);
  }
}

/// A torque that comes at once finds the wheel at rest, and turns it by what is beyond the friction.
TEST(ColumnPlant, ATorqueThatJumpsMeetsTheFrictionAndNoMore) {
  const Column column = locked_column(0.6);
  ColumnPlant plant(column);
  plant.start({});
  ColumnInputs push = inputs(kArm, {}, {}, {}, 0);
  push.voluntary_nm.c0 = 0.5;
  EXPECT_EQ(plant.torques(push).wheel_friction_nm, 0.5);
  push.voluntary_nm.c0 = -2;
  EXPECT_EQ(plant.torques(push).wheel_friction_nm, -0.6);
  const double turning = (-2 + 0.6) / kArm.inertia_kgm2;
  EXPECT_DOUBLE_EQ(plant.torques(push).rim_nm, -2 - (kArm.inertia_kgm2 - column.wheel_inertia_kgm2) * turning);
}

/// The same column by impulses (Moreau's time stepping): in a step the other torques change a mass's momentum, then its
/// friction takes as much as it can, down to rest. It knows no events and no regimes; its error falls with the step.
class ByImpulses {
 public:
  ByImpulses(const Column& column, const WheelArm& arm) : c_(column), arm_(arm) {}

  void advance(const ColumnInputs& now, double span_s, int steps) {
    const double h = span_s / steps;
    for (int i = 0; i < steps; ++i) {
      const double bar = bar_nm();
      const double motor = motor_nm(now.probe_nm.at(i * h), bar);
      const double above =
          now.voluntary_nm.at(i * h) - bar - arm_.damping_nms_per_rad * rate_ - arm_.stiffness_nm_per_rad * angle_;
      const double below = bar + motor + now.road_nm.at(i * h) - c_.column_damping_nms_per_rad * lower_rate_ -
                           c_.aligning_stiffness_nm_per_rad * lower_;
      const double before = rate_;
      rate_ = braked(rate_ + h * above / arm_.inertia_kgm2, h * c_.wheel_friction_nm / arm_.inertia_kgm2);
      lower_rate_ =
          braked(lower_rate_ + h * below / c_.column_inertia_kgm2, h * c_.rack_friction_nm / c_.column_inertia_kgm2);
      acceleration_ = (rate_ - before) / h;
      angle_ += h * rate_;
      lower_ += h * lower_rate_;
    }
  }

  [[nodiscard]] double angle_rad() const { return angle_; }
  [[nodiscard]] double bar_nm() const {
    return c_.bar_stiffness_nm_per_rad * (angle_ - lower_) + c_.bar_damping_nms_per_rad * (rate_ - lower_rate_);
  }
  /// From the arm's side: Tv less what moves the arm.
  [[nodiscard]] double hand_nm(double voluntary_nm) const {
    return voluntary_nm - (arm_.inertia_kgm2 - c_.wheel_inertia_kgm2) * acceleration_ -
           (arm_.damping_nms_per_rad - c_.wheel_damping_nms_per_rad) * rate_ - arm_.stiffness_nm_per_rad * angle_;
  }

 private:
  [[nodiscard]] double motor_nm(double probe_nm, double bar) const {
    const double beyond = std::max(0.0, std::abs(bar) - c_.assist_dead_zone_nm);
    const double asked = c_.assist_gain * std::copysign(beyond, bar) + probe_nm;
    return std::clamp(asked, -c_.motor_limit_nm, c_.motor_limit_nm);
  }

  Column c_;
  WheelArm arm_;
  double angle_ = 0, rate_ = 0, lower_ = 0, lower_rate_ = 0, acceleration_ = 0;
};

/// Greatest differences over a drive, and of the hand's torque, which jumps where the wheel sticks, the rms.
struct Apart {
  double angle_rad = 0;
  double bar_nm = 0;
  double hand_nm = 0;
};

struct Sticking {
  std::string name;
  double wheel_friction_nm;
  double rack_friction_nm;
  WheelArm arm;
};

/// Twice as many steps bring the impulses half as far from the truth: what they are off by then is what they moved.
/// Half as much again is for where the steps meet the kinks.
TEST(ColumnPlant, SticksAndSlipsAsByImpulses) {
  constexpr int kTicks = 1500;
  constexpr int kSteps = 2000;  // of 5 us in a tick
  const Torque road{{{0.3, 2.3, 0.4}, {0.2, 3.9, 2}}};
  for (const Sticking& one : {Sticking{"both", 0.5, 0.75, kArm},
                              {"hands off", 0.2, 0.5, {0.034, 0.055, 0}},
                              {"dry wheel", 1.5, 0.3, {0.08, 1, 12}},
                              {"wheel alone", 0.4, 0, kArm}}) {
    SCOPED_TRACE(one.name);
    Column column;
    column.wheel_friction_nm = one.wheel_friction_nm;
    column.rack_friction_nm = one.rack_friction_nm;
    column.motor_limit_nm = 4;
    ColumnPlant plant(column);
    plant.start({});
    ByImpulses coarse(column, one.arm);
    ByImpulses fine(column, one.arm);
    Apart moved, off;
    std::array<int, 4> regimes{};
    const bool held = one.arm.stiffness_nm_per_rad > 0;
    for (int i = 0; i < kTicks; ++i) {
      const ColumnInputs now = inputs(one.arm, held ? steering(4) : Torque{}, probe(0.5), road, i * kTickS);
      plant.advance(now, kTickS);
      coarse.advance(now, kTickS, kSteps / 2);
      fine.advance(now, kTickS, kSteps);
      const ColumnInputs then = now.shifted(kTickS);
      const ColumnTorques torques = plant.torques(then);
      const double tv = then.voluntary_nm.c0;
      const auto widen = [](double& widest, double a, double b) { widest = std::max(widest, std::abs(a - b)); };
      widen(moved.angle_rad, coarse.angle_rad(), fine.angle_rad());
      widen(moved.bar_nm, coarse.bar_nm(), fine.bar_nm());
      widen(off.angle_rad, plant.state().angle_rad, fine.angle_rad());
      widen(off.bar_nm, torques.bar_nm, fine.bar_nm());
      moved.hand_nm += std::pow(coarse.hand_nm(tv) - fine.hand_nm(tv), 2) / kTicks;
      off.hand_nm += std::pow(torques.rim_nm - fine.hand_nm(tv), 2) / kTicks;
      EXPECT_LE(std::abs(torques.wheel_friction_nm), one.wheel_friction_nm);
      ++regimes.at((plant.wheel_held() ? 1 : 0) + (plant.column_held() ? 2 : 0));
    }
    EXPECT_LT(off.angle_rad, 1.5 * moved.angle_rad);
    EXPECT_LT(off.bar_nm, 1.5 * moved.bar_nm);
    EXPECT_LT(std::sqrt(off.hand_nm), 1.5 * std::sqrt(moved.hand_nm) + 1e-12);  // hands off it is 0
    EXPECT_LT(moved.angle_rad, kTenthOfFloorRad);
    EXPECT_GT(regimes[1], 0);  // the wheel sticks, the column slips
    if (one.rack_friction_nm > 0) {
      EXPECT_GT(regimes[2], 0);
      EXPECT_GT(regimes[3], 0);
    }
  }
}

}  // namespace
}  // namespace steerid::test
