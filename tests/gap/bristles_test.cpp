// Friction with bristles: against closed forms, and against an integrator of the test's own.
#include "gap/bristles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

Record driven(double duration_s, double (*torque_nm)(double)) {
  Record record;
  for (int i = 0; i < static_cast<int>(100 * duration_s); ++i) {
    const double t = i / 100.0;
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(torque_nm(t));
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(0);
  }
  return record;
}

std::vector<double> run(const Record& record, const WheelArm& wheel, const Effect& friction, double bend_rad,
                        WheelState from = {}) {
  return BristleRun(record, {{0, record.size(), from}}, TorqueSignal::Between::kBandLimited)(wheel, friction, bend_rad);
}

/// Held by its bristles the wheel is one with the spring C + F/x.
TEST(Bristles, BelowTheFrictionTheyAreASpring) {
  Effect friction(effect::coulomb_friction);
  friction.at("friction_nm") = 0.5;
  const Record record = driven(20, [](double t) { return 0.3 * (1 - std::exp(-t)); });
  const std::vector<double> angle_rad = run(record, {0.1, 2, 20}, friction, 4e-4);
  const double stiffness = 20 + 0.5 / 4e-4;
  EXPECT_NEAR(angle_rad.back(), 0.3 / stiffness, 1e-3 * 0.3 / stiffness);
}

/// Pulled slowly beyond it, the spring alone carries what friction does not.
TEST(Bristles, BeyondItTheyCarryTheFrictionAndNoMore) {
  Effect friction(effect::asymmetric_friction);
  friction.at("friction_forward_nm") = 0.5;
  friction.at("friction_backward_nm") = 0.2;
  const Record up = driven(40, [](double t) { return 0.1 * t; });
  EXPECT_NEAR(run(up, {0.1, 2, 20}, friction, 4e-4).back(), (0.1 * (39.99 - 2.0 / 20) - 0.5) / 20, 2e-5);
  const Record down = driven(40, [](double t) { return -0.1 * t; });
  EXPECT_NEAR(run(down, {0.1, 2, 20}, friction, 4e-4).back(), -(0.1 * (39.99 - 2.0 / 20) - 0.2) / 20, 2e-5);
}

/// The same law in steps of 10 us by Euler's rule with the rate ahead: its error is some 1e-4 of the swing.
TEST(Bristles, FollowAnIndependentIntegrationOfStribecksFriction) {
  Effect friction(effect::stribeck_friction);
  friction.at("friction_nm") = 0.4;
  friction.at("breakaway_ratio") = 1.8;
  friction.at("stribeck_rate_rad_s") = 0.2;
  const auto torque = [](double t) {
    return 1.5 * std::sin(2 * std::numbers::pi * 0.7 * t) + 0.8 * std::sin(2 * std::numbers::pi * 1.9 * t + 1);
  };
  const Record record = driven(20, torque);
  const WheelArm wheel{0.1, 1.2, 20};
  const double per_bend = 0.4 * 1.8 / 4e-4;
  double angle = 0;
  double rate = 0;
  double bend = 0;
  std::vector<double> expected;
  constexpr int kSteps = 1000;
  for (std::size_t i = 0; i < record.size(); ++i) {
    expected.push_back(angle);
    for (int k = 0; k < kSteps; ++k) {
      const double t = (static_cast<double>(i) + static_cast<double>(k) / kSteps) / 100;
      rate += 0.01 / kSteps * (torque(t) - 1.2 * rate - 20 * angle - per_bend * bend) / 0.1;
      angle += 0.01 / kSteps * rate;
      bend += 0.01 / kSteps * rate;
      const double most = 0.4 * (1 + 0.8 * std::exp(-rate * rate / 0.04)) / per_bend;
      bend = std::clamp(bend, -most, most);
    }
  }
  const std::vector<double> angle_rad = run(record, wheel, friction, 4e-4);
  double squares = 0;
  double power = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    squares += std::pow(angle_rad[i] - expected[i], 2);
    power += std::pow(expected[i], 2);
  }
  EXPECT_LT(std::sqrt(squares / power), 1e-3);
  // And not for any bristles: twice as soft ones part from these by far more.
  const std::vector<double> softer = run(record, wheel, friction, 8e-4);
  double apart = 0;
  for (std::size_t i = 0; i < record.size(); ++i) apart += std::pow(softer[i] - expected[i], 2);
  EXPECT_GT(std::sqrt(apart / power), 5e-3);
}

TEST(Bristles, AreOfDryFrictionOnly) {
  EXPECT_TRUE(is_dry(effect::coulomb_friction));
  EXPECT_FALSE(is_dry(effect::presliding_hysteresis));
}

}  // namespace
}  // namespace steerid
