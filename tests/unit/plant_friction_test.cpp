// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Dry friction, with and without bristles, and hysteresis against closed forms. Tolerances: as in
// plant_closed_form_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>
#include <vector>

#include "plant/free_run.hpp"
#include "plant_drive.hpp"

namespace steerid::test {
namespace {

using namespace effect;

TEST(CoulombFriction, FreeOscillationLosesFourFcOverCACycleAndThenHolds) {
  const WheelArm wheel{0.1, 0, 20};
  const double friction = 0.3;  // rests anywhere within 0.015 rad; the drop is 0.06 rad a cycle
  const std::vector<Effect> effects{with(coulomb_friction, {{"friction_nm", friction}})};
  const Motion motion = free_motion(wheel, effects, {0.4, 0}, 6, 0.001);
  const auto turns = turning_angles(motion);
  // From 0.4 every half cycle takes 2 Fc/C = 0.03 off: 0.37, 0.34 ... until within Fc/C, at 0.01.
  ASSERT_EQ(turns.size(), 12U);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double size = 0.4 - 0.03 * static_cast<double>(i + 1);
    EXPECT_NEAR(turns[i], i % 2 == 0 ? -size : size, 2e-6) << i;  // rests one sample wide blunt the reading
  }
  EXPECT_EQ(motion.rate_rad_s.back(), 0.0);
  EXPECT_NEAR(motion.angle_rad.back(), -0.01, 1e-6);
}

TEST(CoulombFriction, HoldsToTheLastBitBelowItsLevelAndLetsGoAboveIt) {
  const WheelArm wheel{0.1, 0.5, 20};
  const std::vector<Effect> effects{with(coulomb_friction, {{"friction_nm", 0.5}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, {0.01, 0});                                                  // the spring pulls with 0.2
  for (int i = 0; i < 100000; ++i) plant.advance({0.69, 0, 0, 0}, {}, 0.01);  // 0.49 net, for 1000 s
  EXPECT_EQ(plant.state().angle_rad, 0.01);
  EXPECT_EQ(plant.state().rate_rad_s, 0.0);
  EXPECT_TRUE(plant.held());
  plant.advance({0.71, 0, 0, 0}, {}, 0.01);
  EXPECT_GT(plant.state().rate_rad_s, 0.0);
  EXPECT_FALSE(plant.held());
}

TEST(CoulombFriction, BreaksAwayAtTheInstantTheTorqueReachesIt) {
  // No spring, no damping: after breakaway at t0 = 0.5 s the torque's excess is 2 (t - t0), so th = 2 (t - t0)^3/(6 J).
  const WheelArm wheel{0.1, 0, 0};
  const std::vector<Effect> effects{with(coulomb_friction, {{"friction_nm", 1}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, {0, 0});
  const double step = 0.03;  // the instant lies within a step
  for (int i = 0; i < 40; ++i) plant.advance({2 * plant.time_s(), 2, 0, 0}, {}, step);
  const double after = plant.time_s() - 0.5;
  EXPECT_NEAR(plant.state().angle_rad, 2 * after * after * after / 0.6, 1e-8);
}

TEST(CoulombFriction, BendsByTheShareOfItsLevelBeforeItSlips) {
  // No spring of the arm: what balances a torque below the level is the bend alone.
  const WheelArm wheel{0.1, 5, 0};
  const double bend = 1e-3;
  const std::vector<Effect> effects{with(coulomb_friction, {{"friction_nm", 0.5}, {"bristle_rad", bend}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, {0, 0});
  for (const double torque : {0.1, 0.3, -0.2}) {  // back and forth without loss: it has not slipped
    for (int i = 0; i < 500; ++i) plant.advance({torque, 0, 0, 0}, {}, 0.01);
    EXPECT_NEAR(plant.state().angle_rad, torque / 0.5 * bend, 1e-9) << torque;
  }
  for (int i = 0; i < 500; ++i) plant.advance({0.51, 0, 0, 0}, {}, 0.01);
  EXPECT_GT(plant.state().angle_rad, 10 * bend);  // 0.01 Nm against B for 5 s are 10 mrad
  const double slipped = plant.state().angle_rad;
  for (int i = 0; i < 500; ++i) plant.advance({}, {}, 0.01);
  EXPECT_NEAR(plant.state().angle_rad, slipped - bend, 2e-5);  // springs back by what it was bent, and stays
}

TEST(CoulombFriction, SmallMovementsFeelTheBristlesAsAStiffness) {
  // Half a millirad of 1 mrad: 0.5 Nm over 1 mrad are 500 Nm/rad beside C. The period is 2 pi sqrt(J/(C + 500)).
  const WheelArm wheel{0.1, 0, 20};
  const std::vector<Effect> effects{with(coulomb_friction, {{"friction_nm", 0.5}, {"bristle_rad", 1e-3}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, {0, 0.03});  // swings to 0.03/72 rad = 0.42 mrad
  const double period = 2 * std::numbers::pi * std::sqrt(0.1 / 520);
  const int count = 1000;
  for (int i = 0; i < count; ++i) {
    plant.advance({}, {}, period / 100);
    const double phase = 2 * std::numbers::pi * (i + 1) / 100;
    ASSERT_NEAR(plant.state().angle_rad, 0.03 / std::sqrt(5200.0) * std::sin(phase), 1e-12) << i;  // exact steps
  }
}

TEST(CoulombFriction, SlipsWhereItIsBentFarEnoughAndSpringsBackFromWhereItStops) {
  // Thrown against bent bristles, no damping and no spring of the arm: until it slips a swing, w t1 = asin(b w/v0);
  // then slowed down by F/J from v1 = sqrt(v0^2 - (b w)^2); at rest it has come to b + J v1^2/2F, and from there it
  // swings with amplitude b around where the bristles are straight.
  const double inertia = 0.1;
  const double friction = 0.5;
  const double bend = 1e-3;
  const double swing = std::sqrt(friction / bend / inertia);
  const std::vector<Effect> effects{with(coulomb_friction, {{"friction_nm", friction}, {"bristle_rad", bend}})};
  struct Throw {
    double ratio;  // to the rate that just bends them as far as they go
    double step_s;
    double tolerance_rad;
  };
  // The instants lie within steps; of the second throw both ends of a step lie below the bend that it has in between.
  for (const auto& [ratio, step_s, tolerance_rad] : {Throw{2.1, 0.003, 2e-7}, Throw{1.02, 0.0252, 1e-6}}) {
    const double thrown = ratio * bend * swing;
    const double slips_at_s = std::asin(1 / ratio) / swing;
    const double slip_rate = std::sqrt(thrown * thrown - std::pow(bend * swing, 2));
    const double slides_s = slip_rate * inertia / friction;
    const double stops_at_rad = bend + inertia * slip_rate * slip_rate / (2 * friction);
    Plant plant(effects, {.wheel = {inertia, 0, 0}});
    plant.start(0, {0, thrown});
    while (plant.time_s() < 0.3) {
      plant.advance({}, {}, step_s);
      const double slid_s = plant.time_s() - slips_at_s;
      const double back_s = slid_s - slides_s;
      const double expected = slid_s < 0   ? thrown / swing * std::sin(swing * plant.time_s())
                              : back_s < 0 ? bend + slid_s * (slip_rate - slid_s * friction / inertia / 2)
                                           : stops_at_rad - bend * (1 - std::cos(swing * back_s));
      ASSERT_NEAR(plant.state().angle_rad, expected, tolerance_rad) << ratio << ", " << plant.time_s() << " s";
    }
  }
}

TEST(StribeckFriction, BreaksAwayAtItsStaticLevelAndSlidesAtItsKineticOne) {
  const WheelArm wheel{0.1, 1, 0};
  const std::vector<Effect> effects{
      with(stribeck_friction, {{"friction_nm", 0.5}, {"breakaway_ratio", 2}, {"stribeck_rate_rad_s", 0.1}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, {0, 0});
  for (int i = 0; i < 1000; ++i) plant.advance({0.999, 0, 0, 0}, {}, 0.01);
  EXPECT_EQ(plant.state().angle_rad, 0.0);
  for (int i = 0; i < 1000; ++i) plant.advance({1.01, 0, 0, 0}, {}, 0.01);
  // Steady sliding: B w + Fc + (Fs - Fc) exp(-(w/vs)^2) = T; at w = 0.5 the last term is 0.5 exp(-25), nothing. (A
  // torque of 1.001 would creep at 1 mrad/s instead: there the damping rises faster than the friction falls.)
  EXPECT_NEAR(plant.state().rate_rad_s, 0.51, 1e-6);
}

TEST(AsymmetricFriction, EachHalfCycleLosesTwiceItsOwnFriction) {
  const WheelArm wheel{0.1, 0, 20};
  const std::vector<Effect> effects{
      with(asymmetric_friction, {{"friction_forward_nm", 0.1}, {"friction_backward_nm", 0.4}})};
  const auto turns = turning_angles(free_motion(wheel, effects, {0.5, 0}, 3, 0.001));
  ASSERT_GE(turns.size(), 4U);
  // Backward over F-/C = 0.02: 0.5 -> -0.46; forward over F+/C = 0.005: -> 0.45; and so on.
  EXPECT_NEAR(turns[0], -0.46, 2e-6);
  EXPECT_NEAR(turns[1], 0.45, 2e-6);
  EXPECT_NEAR(turns[2], -0.41, 2e-6);
  EXPECT_NEAR(turns[3], 0.40, 2e-6);
}

TEST(PreslidingHysteresis, FollowsDahlsExponentialInTheAngle) {
  // Monotonic turning from z = 0: z = 1 - exp(-th/x). A free wheel (C = B = 0) slowed by F z alone: energy balance
  // J w^2/2 = J w0^2/2 - F (th - x (1 - exp(-th/x))).
  const WheelArm wheel{0.1, 0, 0};
  const double force = 0.5;
  const double x = 0.05;
  const std::vector<Effect> effects{with(presliding_hysteresis, {{"friction_nm", force}, {"presliding_rad", x}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, {0, 2});
  for (int i = 0; i < 30; ++i) {
    plant.advance({}, {}, 0.01);
    const double th = plant.state().angle_rad;
    const double work = force * (th - x * (1 - std::exp(-th / x)));
    EXPECT_NEAR(plant.state().rate_rad_s, std::sqrt(4 - 2 * work / wheel.inertia_kgm2),
                2e-5);  // a tenth of the floor a second
  }
}

TEST(PreslidingHysteresis, BeginsAsIfItHadBeenTurnedFromZero) {
  // Held still at th, z is 1 - exp(-|th|/x) for n = 1 and tanh(|th|/x) for n = 2, against what turned it there; it
  // alone starts the heavy wheel.
  const WheelArm wheel{50, 0, 0};
  const double x = 0.1;
  for (const double shape : {0.0, 1.0}) {
    for (const auto& [n, angle_rad, expected] : {std::tuple{1.0, 0.08, 1 - std::exp(-0.8)},
                                                 {1.0, 0.0, 0.0},
                                                 {1.0, -0.15, -(1 - std::exp(-1.5))},
                                                 {2.0, -0.05, -std::tanh(0.5)}}) {
      const std::vector<Effect> effects{with(
          presliding_hysteresis, {{"friction_nm", 1}, {"presliding_rad", x}, {"sharpness", n}, {"loop_shape", shape}})};
      Plant plant(effects, {.wheel = wheel});
      plant.start(0, {angle_rad, 0});
      plant.advance({}, {}, 0.001);
      EXPECT_NEAR(plant.state().rate_rad_s / 0.001 * 50, -expected, 1e-3) << n << " " << angle_rad << " " << shape;
    }
  }
}

TEST(PreslidingHysteresis, ClosedLoopsLoseTheEnergyOfItsLoop) {
  // Forced slowly between +-A the torque traces the loop z = 1 - (1 + z0) exp(-(th + A)/x) with z(A) = -z(-A) = z0,
  // so z0 = tanh(A/x). Half the loop's area is F (2 A - 2 x z0) of work.
  const WheelArm stiff{0.1, 5, 200};
  const double force = 2;
  const double x = 0.02;
  const std::vector<Effect> effects{with(presliding_hysteresis, {{"friction_nm", force}, {"presliding_rad", x}})};
  Plant plant(effects, {.wheel = stiff});
  plant.start(0, {0, 0});
  const Torque drive{{{10, 0.2, 0}}};
  double work = 0;
  double viscous = 0;
  double highest = 0;
  const double h = 0.001;
  for (int i = 0; i < 20000; ++i) {
    const double t = i * h;
    const WheelState before = plant.state();
    plant.advance(drive.piece(t, h), {}, h);
    if (i < 15000) continue;  // the last of four periods
    const double moved = plant.state().angle_rad - before.angle_rad;
    work += drive.at(t + h / 2) * moved;
    viscous += stiff.damping_nms_per_rad * moved * moved / h;
    highest = std::max(highest, plant.state().angle_rad);
  }
  EXPECT_NEAR(work - viscous, 2 * force * (2 * highest - 2 * x * std::tanh(highest / x)), 1e-4);
}

TEST(PreslidingHysteresis, SharpnessBringsItTowardsSpringAndSlider) {
  // dz/dth = (1 - z^n)/x: at th = x the force is tanh(1) for n = 2 and tends to 1 for large n.
  const WheelArm wheel{5000, 0, 0};  // heavy: turns at a steady rate
  for (const auto& [n, expected] : {std::pair{1.0, 1 - std::exp(-1.0)}, {2.0, std::tanh(1.0)}}) {
    const std::vector<Effect> effects{
        with(presliding_hysteresis, {{"friction_nm", 1}, {"presliding_rad", 0.1}, {"sharpness", n}})};
    Plant plant(effects, {.wheel = wheel});
    plant.start(0, {0, 0.1});
    for (int i = 0; i < 100; ++i) plant.advance({}, {}, 0.01);
    const double before = plant.state().rate_rad_s;
    plant.advance({}, {}, 0.001);
    EXPECT_NEAR((before - plant.state().rate_rad_s) / 0.001 * 5000, expected, 1e-3) << n;
  }
}

/// Moving, turning and at rest: a driver of 0.6 Nm moves the wheel by jerks.
TEST(AsymmetricFriction, IsFrictionInBothDirectionsBesideAnOffsetOfTheTorque) {
  const WheelArm wheel{0.11, 1.5, 22.7};
  const Effect asymmetric = with(asymmetric_friction, {{"friction_forward_nm", 0.5}, {"friction_backward_nm", 0.1}});
  const std::vector<Effect> two = {with(coulomb_friction, {{"friction_nm", 0.3}}),
                                   with(torque_bias, {{"bias_nm", 0.2}})};
  for (const double amplitude_nm : {0.6, 3.0}) {
    const Record record = record_of(steering(amplitude_nm), probe(0.05), 20);
    FreeRun one(record);
    FreeRun other(record);
    const WheelState rest{0, 0};
    const std::span<const double> found = one(wheel, std::vector<Effect>{asymmetric}, rest);
    const std::vector<double> angle_rad(found.begin(), found.end());
    EXPECT_LT(worst_difference(angle_rad, other(wheel, two, rest)), 1e-6) << amplitude_nm;
    EXPECT_GT(std::ranges::max(angle_rad) - std::ranges::min(angle_rad), 0.01) << amplitude_nm;
  }
  // With bristles, once these have slipped.
  Effect bent = asymmetric;
  bent.at("bristle_rad") = 0.0015;
  const Record record = record_of(steering(3.0), probe(0.05), 20);
  FreeRun one(record);
  FreeRun other(record);
  const std::span<const double> found = one(wheel, std::vector<Effect>{bent}, WheelState{});
  const std::span<const double> alike = other(wheel, asymmetric_friction.same_motion_as(bent.values), WheelState{});
  const std::size_t first = 500;
  const std::vector<double> angle_rad(found.begin() + first, found.end());
  EXPECT_LT(worst_difference(angle_rad, alike.subspan(first)), 1e-5);

  const std::vector<Effect> others = asymmetric_friction.same_motion_as(asymmetric.values);
  ASSERT_EQ(others.size(), two.size());
  for (std::size_t i = 0; i < two.size(); ++i) {
    EXPECT_EQ(others[i].type, two[i].type);
    for (std::size_t k = 0; k < two[i].values.size(); ++k) EXPECT_NEAR(others[i].values[k], two[i].values[k], 1e-12);
  }
  const auto back = asymmetric_friction.values_of_same_motion(others);
  ASSERT_TRUE(back.has_value());
  for (std::size_t k = 0; k < back->size(); ++k) EXPECT_NEAR((*back)[k], asymmetric.values[k], 1e-12);
  std::vector<Effect> offset = others;  // the wheel is pushed by more than the friction holds: no friction does that
  offset[1].values[0] = 1.1 * offset[0].values[0];
  EXPECT_FALSE(asymmetric_friction.values_of_same_motion(offset).has_value());
}

}  // namespace
}  // namespace steerid::test
