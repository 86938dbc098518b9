// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Records with a torque written the wrong way round are told so; good ones are never accused. Drives are made by an
// integrator of the test's own.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fit/gauss_newton.hpp"
#include "fit/sign_check.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

/// What is not linear about the wheel, and what no sensor sees.
struct Wheel {
  WheelArm arm;
  double friction_nm = 0;
  double cubic_nm_per_rad3 = 0;
  double unmeasured_nm = 0;
};

/// 20 s at 100 Hz: the driver steers and the motor plays a triangle and a probe, each of its own size.
Record drive(const Wheel& wheel, double driver_nm, double triangle_nm, double probe_nm, std::mt19937_64& random) {
  constexpr int kSteps = 5;
  constexpr double kTurn = 6.283185307179586;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> phase(0, kTurn);
  const double phases[] = {phase(random), phase(random), phase(random), phase(random), phase(random)};
  constexpr double kTones_hz[] = {0.3, 0.8, 1.7, 2.9, 4.3};
  const double slow[] = {phase(random), phase(random)};
  Record record;
  double angle = 0, rate = 0;
  for (int k = 0; k < 2'000; ++k) {
    double driver = 0, motor = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double t = 0.01 * k + 0.01 / kSteps * i;
      driver = driver_nm * (std::sin(kTurn * 0.25 * t + phases[0]) + 0.3 * std::sin(kTurn * 0.61 * t + phases[1]));
      motor = triangle_nm * (std::asin(std::sin(kTurn * 0.025 * t)) / 1.5708);
      for (int n = 0; n < 5; ++n) motor += probe_nm * std::sin(kTurn * kTones_hz[n] * t + phases[n]);
      const double unmeasured =
          wheel.unmeasured_nm * (std::sin(kTurn * 0.13 * t + slow[0]) + std::sin(kTurn * 0.37 * t + slow[1]));
      if (i == 0) {
        record.time_s.push_back(t);
        record.torque_driver_nm.push_back(driver + 0.03 * normal(random));
        record.torque_motor_nm.push_back(motor + 0.009 * normal(random));
        record.angle_rad.push_back(angle + 0.0007 * normal(random));
      }
      const double torque = driver - motor + unmeasured - wheel.arm.damping_nms_per_rad * rate -
                            wheel.arm.stiffness_nm_per_rad * angle - wheel.cubic_nm_per_rad3 * angle * angle * angle -
                            wheel.friction_nm * std::tanh(rate / 0.01);
      rate += 0.01 / kSteps * torque / wheel.arm.inertia_kgm2;
      angle += 0.01 / kSteps * rate;
    }
  }
  return record;
}

void turn(std::vector<double>& channel) {
  for (double& value : channel) value = -value;
}

constexpr Wheel kNominal{{0.11, 1.5, 22.7}};

TEST(SignCheck, FindsTheChannelThatIsTurnedRound) {
  std::mt19937_64 random(test::seed(31));
  for (const Wheel& wheel : {kNominal, Wheel{{0.06, 0.4, 2.0}}, Wheel{{0.11, 1.5, 22.7}, 0.1, 0, 0.05}}) {
    const Record good = drive(wheel, 3, 0, 0.7, random);
    EXPECT_FALSE(check_signs(good, true).doubtful());
    Record driver = good;
    turn(driver.torque_driver_nm);
    Record motor = good;
    turn(motor.torque_motor_nm);
    Record both = driver;
    turn(both.torque_motor_nm);
    for (const auto& [record, driver_off, motor_off] :
         {std::tuple{driver, true, false}, {motor, false, true}, {both, true, true}}) {
      const SignCheck check = check_signs(record, true);
      EXPECT_EQ(check.torque_driver, driver_off);
      EXPECT_EQ(check.torque_motor, motor_off);
      EXPECT_LT(4 * check.unexplained_turned, check.unexplained);
    }
  }
}

TEST(SignCheck, OneTorqueAloneCanBeTurnedRound) {
  std::mt19937_64 random(test::seed(32));
  Record record = drive(kNominal, 0, 0, 0.7, random);
  std::fill(record.torque_driver_nm.begin(), record.torque_driver_nm.end(), 0.0);
  EXPECT_FALSE(check_signs(record, true).doubtful());
  turn(record.torque_motor_nm);
  EXPECT_TRUE(check_signs(record, true).torque_motor);
}

// The batch fit's own answer to such a record is what must not reach a user: an inertia that is far off, or none.
TEST(SignCheck, IsNeeded) {
  std::mt19937_64 random(test::seed(33));
  Record record = drive(kNominal, 3, 0, 0.7, random);
  turn(record.torque_motor_nm);
  const BatchFit fit = fit_batch(record);
  const bool right = fit.inertia.state == ParameterState::kValid && std::abs(fit.inertia.value / 0.11 - 1) < 0.1 &&
                     std::abs(fit.stiffness.value / 22.7 - 1) < 0.1;
  EXPECT_FALSE(right);
}

// Thirty drives of all kinds: light to braced arms, with and without friction, hardening spring, unmeasured torque, by
// the driver, the triangle or the probe alone and together.
TEST(SignCheck, NeverAccusesAGoodRecord) {
  std::mt19937_64 random(test::seed(34));
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 30; ++i) {
    Wheel wheel{{between(0.04, 0.18), between(0.3, 4), between(1, 60)}};
    if (i % 3 == 1) wheel.friction_nm = between(0.05, 0.5);
    if (i % 5 == 2) wheel.cubic_nm_per_rad3 = between(1, 50);
    if (i % 4 == 3) wheel.unmeasured_nm = between(0.02, 0.3);
    const double driver_nm = i % 2 == 0 ? between(0.1, 5) : 0.05;
    const double triangle_nm = i % 7 < 3 ? 5 : 0;
    const double probe_nm = i % 2 == 1 || i % 4 == 0 ? between(0.2, 0.9) : 0;
    const SignCheck check = check_signs(drive(wheel, driver_nm, triangle_nm, probe_nm, random), true);
    EXPECT_FALSE(check.doubtful()) << i << ": J " << wheel.arm.inertia_kgm2 << " B " << wheel.arm.damping_nms_per_rad
                                   << " C " << wheel.arm.stiffness_nm_per_rad << " friction " << wheel.friction_nm
                                   << " cubic " << wheel.cubic_nm_per_rad3 << " driver " << driver_nm << " triangle "
                                   << triangle_nm << " probe " << probe_nm << " unexplained " << check.unexplained
                                   << " turned " << check.unexplained_turned;
  }
}

TEST(SignCheck, SaysNothingOfNothing) {
  const SignCheck check = check_signs({}, true);
  EXPECT_FALSE(check.doubtful());
  EXPECT_TRUE(std::isnan(check.unexplained));
}

}  // namespace
}  // namespace steerid
