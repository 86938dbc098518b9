// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whole column against what can be said without it: the response of two masses on a bar in closed form, a balance
// of energy, and halved steps. Its dry friction has a test of its own (column_friction_test.cpp).
#include "plant/column_plant.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "column_inputs.hpp"
#include "log/bad_input.hpp"
#include "plant_drive.hpp"

namespace steerid::test {
namespace {

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
