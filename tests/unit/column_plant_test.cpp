// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whole column against what can be said without it: the response of two masses on a bar in closed form, a balance
// of energy, friction that really holds, a wheel with friction in closed form, an integrator that takes friction as
// impulses, and halved steps.
#include "plant/column_plant.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "plant_drive.hpp"

namespace steerid::test {
namespace {

constexpr WheelArm kArm{0.11, 1.5, 22.7};

ColumnInputs inputs(const WheelArm& arm, const Torque& voluntary, const Torque& probe, const Torque& road, double t,
                    double h = kTickS) {
  return {voluntary.piece(t, h),
          probe.piece(t, h),
          road.piece(t, h),
          {arm.inertia_kgm2, 0, 0, 0},
          {arm.damping_nms_per_rad, 0, 0, 0},
          {arm.stiffness_nm_per_rad, 0, 0, 0}};
}

/// Without friction and with an assist that has no dead zone: linear.
Column linear_column() {
  Column column;
  column.rack_friction_nm = 0;
  column.assist_dead_zone_nm = 0;
  column.bar_damping_nms_per_rad = 0.4;
  return column;
}

using Complex = std::complex<double>;
struct Response {
  Complex angle;  ///< rad/Nm
  Complex bar;    ///< Nm/Nm
  Complex rim;    ///< Nm/Nm
};

/// Of the linear column at `hz`, to one Nm of voluntary torque (`above`) or of probe: by Cramer's rule on
///   (J s^2 + B s + C + k) th - k ph = Tv                      k = kt + bt s
///   -(1 + g) k th + (Jc s^2 + Bc s + Cr + (1 + g) k) ph = Tp
Response closed_form(const Column& c, const WheelArm& arm, double hz, bool above) {
  const Complex s(0, kTwoPi * hz);
  const Complex k = c.bar_stiffness_nm_per_rad + c.bar_damping_nms_per_rad * s;
  const double answered = 1 + c.assist_gain;
  const Complex a11 = arm.inertia_kgm2 * s * s + arm.damping_nms_per_rad * s + arm.stiffness_nm_per_rad + k;
  const Complex a22 =
      c.column_inertia_kgm2 * s * s + c.column_damping_nms_per_rad * s + c.aligning_stiffness_nm_per_rad + answered * k;
  const Complex determinant = a11 * a22 - answered * k * k;
  const Complex th = (above ? a22 : k) / determinant;
  const Complex ph = (above ? answered * k : a11) / determinant;
  const Complex bar = k * (th - ph);
  return {th, bar, (c.wheel_inertia_kgm2 * s * s + c.wheel_damping_nms_per_rad * s) * th + bar};
}

/// The complex amplitude of `values`, a row a tick over whole periods.
Complex amplitude(const std::vector<double>& values, double hz, double from_s) {
  Complex sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += values[i] * std::polar(1.0, -kTwoPi * hz * (from_s + static_cast<double>(i) * kTickS));
  }
  return 2.0 / static_cast<double>(values.size()) * sum * Complex(0, 1);  // to a sine
}

TEST(ColumnPlant, AnswersSinesAsTwoMassesOnABarDo) {
  constexpr double kSettleS = 20;
  constexpr double kLengthS = 20;
  for (const double hz : {0.1, 0.5, 2.0, 5.0, 8.0}) {
    for (const bool above : {true, false}) {
      SCOPED_TRACE(std::to_string(hz) + (above ? " Hz, driver" : " Hz, probe"));
      const Column column = linear_column();
      const Torque sine{{{1.0, hz, 0}}};
      const Torque none;
      ColumnPlant plant(column);
      plant.start({});
      std::vector<double> angle, bar, rim;
      for (int i = 0; i < static_cast<int>(std::lround((kSettleS + kLengthS) / kTickS)); ++i) {
        const ColumnInputs now = inputs(kArm, above ? sine : none, above ? none : sine, none, i * kTickS);
        if (i * kTickS >= kSettleS - 1e-9) {
          const ColumnTorques torques = plant.torques(now);
          angle.push_back(plant.state().angle_rad);
          bar.push_back(torques.bar_nm);
          rim.push_back(torques.rim_nm);
        }
        plant.advance(now, kTickS);
      }
      const Response expected = closed_form(column, kArm, hz, above);
      // The torque's cubics are (2 pi f h)^4 / 384 from the sine: 2e-4 at 8 Hz.
      const double tolerance = 1e-5 + std::pow(kTwoPi * hz * kTickS, 4) / 384;
      EXPECT_LT(std::abs(amplitude(angle, hz, kSettleS) / expected.angle - 1.0), tolerance);
      EXPECT_LT(std::abs(amplitude(bar, hz, kSettleS) / expected.bar - 1.0), tolerance);
      EXPECT_LT(std::abs(amplitude(rim, hz, kSettleS) / expected.rim - 1.0), tolerance);
    }
  }
}

/// Kinetic and spring energy, J.
double energy(const Column& c, const WheelArm& arm, const ColumnState& x) {
  const double twist = x.angle_rad - x.column_angle_rad;
  return 0.5 * (arm.inertia_kgm2 * x.rate_rad_s * x.rate_rad_s +
                c.column_inertia_kgm2 * x.column_rate_rad_s * x.column_rate_rad_s +
                arm.stiffness_nm_per_rad * x.angle_rad * x.angle_rad + c.bar_stiffness_nm_per_rad * twist * twist +
                c.aligning_stiffness_nm_per_rad * x.column_angle_rad * x.column_angle_rad);
}

/// What flows in less what is lost, W.
double power(const Column& c, const WheelArm& arm, const ColumnInputs& now, const ColumnPlant& plant) {
  const ColumnState x = plant.state();
  const ColumnTorques t = plant.torques(now);
  const double twisting = x.rate_rad_s - x.column_rate_rad_s;
  return now.voluntary_nm.c0 * x.rate_rad_s + (t.motor_nm + now.road_nm.c0 - t.rack_friction_nm) * x.column_rate_rad_s -
         c.wheel_friction_nm * std::abs(x.rate_rad_s) - arm.damping_nms_per_rad * x.rate_rad_s * x.rate_rad_s -
         c.bar_damping_nms_per_rad * twisting * twisting -
         c.column_damping_nms_per_rad * x.column_rate_rad_s * x.column_rate_rad_s;
}

class BalanceOfEnergy : public testing::TestWithParam<double> {};

TEST_P(BalanceOfEnergy, IsKept) {
  Column column;
  column.wheel_friction_nm = GetParam();
  column.motor_limit_nm = 3;  // clips now and then
  column.bar_damping_nms_per_rad = 0.3;
  ColumnPlant plant(column);
  plant.start({});
  const Torque road{{{0.4, 1.7, 1.0}}};
  constexpr double kH = 2.5e-4;
  double work = 0;
  double moved = 0;  // all energy that went either way
  double before = 0;
  for (int i = 0; i < 40'000; ++i) {
    const ColumnInputs now = inputs(kArm, steering(6), probe(), road, i * kH, kH);
    const double flow = power(column, kArm, now, plant);
    work += 0.5 * (flow + before) * (i == 0 ? 0 : kH);
    moved += std::abs(flow) * kH;
    before = flow;
    plant.advance(now, kH);
  }
  const double flow = power(column, kArm, inputs(kArm, steering(6), probe(), road, 10.0, kH), plant);
  work += 0.5 * (flow + before) * kH;
  EXPECT_GT(moved, 5);
  EXPECT_NEAR(energy(column, kArm, plant.state()), work, 2e-5 * moved);
}
INSTANTIATE_TEST_SUITE_P(ColumnPlant, BalanceOfEnergy, testing::Values(0.0, 0.5));

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
      rate_ = slowed(rate_ + h * above / arm_.inertia_kgm2, h * c_.wheel_friction_nm / arm_.inertia_kgm2);
      lower_rate_ =
          slowed(lower_rate_ + h * below / c_.column_inertia_kgm2, h * c_.rack_friction_nm / c_.column_inertia_kgm2);
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
  static double slowed(double rate, double by) { return std::copysign(std::max(0.0, std::abs(rate) - by), rate); }
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

TEST(ColumnPlant, StandsWhereTheSpringsSay) {
  Column column;
  column.rack_friction_nm = 0;
  column.motor_limit_nm = 2;
  const double voluntary = 12;
  ColumnPlant plant(column);
  plant.start({});
  ColumnInputs push = inputs(kArm, {}, {}, {}, 0);
  push.voluntary_nm.c0 = voluntary;
  for (int i = 0; i < 3000; ++i) plant.advance(push, kTickS);
  // The motor is at its limit: Cr ph = bar + 2, C th = 12 - bar, bar = kt (th - ph).
  const double kt = column.bar_stiffness_nm_per_rad;
  const double cr = column.aligning_stiffness_nm_per_rad;
  const double c = kArm.stiffness_nm_per_rad;
  const double bar = (voluntary / c - 2 / cr) / (1 / kt + 1 / c + 1 / cr);
  ASSERT_GT(column.assist_gain * (bar - column.assist_dead_zone_nm), 2);
  EXPECT_NEAR(plant.torques(push).bar_nm, bar, 1e-6);
  EXPECT_EQ(plant.torques(push).motor_nm, 2);
  EXPECT_NEAR(plant.torques(push).rim_nm, bar, 1e-6);
  EXPECT_NEAR(plant.state().angle_rad, (voluntary - bar) / c, 1e-8);
}

struct Corner {
  std::string name;
  Column column;
  WheelArm arm;
};

std::vector<Corner> corners() {
  const auto with = [](double Column::*field, double value) {
    Column column;
    column.*field = value;
    return column;
  };
  return {{"usual", {}, kArm},
          {"hands off", {}, {0.034, 0.055, 0}},
          {"stiff bar", with(&Column::bar_stiffness_nm_per_rad, 400), {0.05, 0.8, 80}},
          {"strong assist", with(&Column::assist_gain, 8), {0.18, 0.4, 5}},
          {"no friction", with(&Column::rack_friction_nm, 0), kArm},
          {"dry column", with(&Column::rack_friction_nm, 3), {0.02, 4.4, 13}},
          {"dry wheel", with(&Column::wheel_friction_nm, 0.7), kArm},
          {"dry wheel, hands off", with(&Column::wheel_friction_nm, 0.3), {0.034, 0.055, 0}},
          {"weak motor", with(&Column::motor_limit_nm, 1), kArm}};
}

TEST(ColumnPlant, HalvedStepsChangeNothingThatASensorSees) {
  for (const Corner& corner : corners()) {
    SCOPED_TRACE(corner.name);
    ColumnPlant plain(corner.column);
    ColumnPlant fine(corner.column);
    fine.refine(8);
    plain.start({});
    fine.start({});
    const Torque road{{{0.3, 2.3, 0.4}, {0.2, 3.9, 2}}};
    double angle_rad = 0;
    double bar_nm = 0;
    for (int i = 0; i < 2000; ++i) {
      const ColumnInputs now = inputs(corner.arm, steering(4), probe(), road, i * kTickS);
      plain.advance(now, kTickS);
      fine.advance(now, kTickS);
      const ColumnInputs then = inputs(corner.arm, steering(4), probe(), road, (i + 1) * kTickS);
      angle_rad = std::max(angle_rad, std::abs(plain.state().angle_rad - fine.state().angle_rad));
      bar_nm = std::max(bar_nm, std::abs(plain.torques(then).bar_nm - fine.torques(then).bar_nm));
    }
    EXPECT_LT(angle_rad, kTenthOfFloorRad);
    EXPECT_LT(bar_nm, 2e-3);  // a tenth of a good torque sensor's noise
  }
}

TEST(Column, ComesBackFromItsFileAsItWent) {
  Column column;
  column.wheel_friction_nm = 0.4;
  column.bar_stiffness_nm_per_rad = 123.4;
  column.probe_delay_s = 0.02;
  column.sensors_json = R"({"angle":{"noise":{"sd_rad":0.001}}})";
  const Column back = Column::from_json(column.to_json(), "column.json");
  EXPECT_EQ(back.to_json(), column.to_json());
  EXPECT_EQ(back.bar_stiffness_nm_per_rad, 123.4);
  EXPECT_EQ(back.wheel_friction_nm, 0.4);
  EXPECT_EQ(back.sensors_json, column.sensors_json);
  EXPECT_EQ(Column::from_json("{}", "column.json").to_json(), Column{}.to_json());
  EXPECT_EQ(Column::from_json("{}", "column.json").wheel_friction_nm, 0);
}

std::string refusal(const std::string& text) {
  try {
    (void)Column::from_json(text, "column.json");
  } catch (const BadInput& error) {
    return error.what();
  }
  return "was taken";
}

TEST(Column, RefusesWhatIsNoColumn) {
  EXPECT_EQ(
      refusal(R"({"bar_stiffness_nm_per_rad": "150"})"),
      "column.json, at /bar_stiffness_nm_per_rad: expected a number from 10 to 10000, found \"\"150\"\"; leave the "
      "key out for 150");
  EXPECT_NE(refusal(R"({"assist_gain": -1})").find("at /assist_gain: expected a number from 0 to 20"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"wheel_friction_nm": 21})").find("at /wheel_friction_nm: expected a number from 0 to 20"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"bar_stifness": 1})").find("found the key \"bar_stifness\"; check its spelling"),
            std::string::npos);
  EXPECT_NE(refusal("[]").find("expected an object"), std::string::npos);
  EXPECT_NE(refusal("{").find("column.json"), std::string::npos);
}

}  // namespace
}  // namespace steerid::test
