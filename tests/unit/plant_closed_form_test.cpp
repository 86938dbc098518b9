// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The effects against closed forms. Tolerances: the integrator may be off by kTenthOfFloorRad (0.003 degree), the
// closed forms are exact unless a comment says otherwise.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "plant/effects/hands_away.hpp"
#include "plant/recorder.hpp"
#include "plant_drive.hpp"

namespace steerid::test {
namespace {

using namespace effect;

/// Times at which the angle passes through zero upwards, by straight lines between close samples.
std::vector<double> upward_zeros(const Motion& motion) {
  std::vector<double> times;
  for (std::size_t i = 1; i < motion.time_s.size(); ++i) {
    const double a = motion.angle_rad[i - 1];
    const double b = motion.angle_rad[i];
    if (a < 0 && b >= 0)
      times.push_back(motion.time_s[i - 1] - a * (motion.time_s[i] - motion.time_s[i - 1]) / (b - a));
  }
  return times;
}

TEST(CubicStiffness, DuffingKeepsItsEnergy) {
  const WheelArm wheel{0.1, 0, 20};
  const double cubic = 40;
  const std::vector<Effect> effects{with(cubic_stiffness, {{"cubic_stiffness_nm_per_rad3", cubic}})};
  const Motion motion = free_motion(wheel, effects, {0.8, 0}, 20);
  const auto energy = [&](std::size_t i) {
    const double th = motion.angle_rad[i];
    const double w = motion.rate_rad_s[i];
    return 0.05 * w * w + 10 * th * th + 10 * th * th * th * th;
  };
  // The amplitude that this energy stands for may move by a tenth of the floor: dE = (C A + C3 A^3) dA.
  const double tolerance = (20 * 0.8 + 40 * 0.512) * kTenthOfFloorRad;
  for (std::size_t i = 0; i < motion.time_s.size(); ++i) EXPECT_NEAR(energy(i), energy(0), tolerance) << i;
}

TEST(QuadraticDamping, AmplitudesFollowTheEnergyEquation) {
  // Between turns, with e = w^2: de/dth = -2 (C th + B2 |w| w sgn)/J is linear in e, and the next turn from A solves
  // (1 + 2 b A) exp(-2 b A) = (1 - 2 b A') exp(2 b A'), b = B2/J, A' > 0 on the other side.
  const WheelArm wheel{0.1, 0, 20};
  const std::vector<Effect> effects{with(quadratic_damping, {{"quadratic_damping_nms2_per_rad2", 0.08}})};
  const double b = 0.8;
  const auto turns = turning_angles(free_motion(wheel, effects, {0.9, 0}, 2, 0.001));
  ASSERT_GE(turns.size(), 5U);
  double from = 0.9;
  for (std::size_t i = 0; i < 5; ++i) {
    const double to = std::abs(turns[i]);
    EXPECT_NEAR((1 + 2 * b * from) * std::exp(-2 * b * from), (1 - 2 * b * to) * std::exp(2 * b * to), 1e-5) << i;
    EXPECT_LT(to, from);
    from = to;
  }
}

TEST(Backlash, PeriodIsThatOfTheSpringPlusTheTimeInTheGap) {
  // Undamped, from A: half a cycle of the spring at amplitude A - g on either side, and 2 g at the speed (A - g) w0.
  const WheelArm wheel{0.1, 0, 20};
  const double gap = 0.05;
  const std::vector<Effect> effects{with(backlash, {{"half_gap_rad", gap}})};
  const double natural = std::sqrt(200);
  const double speed = 0.25 * natural;
  const double period = kTwoPi / natural + 4 * gap / speed;
  const auto zeros = upward_zeros(free_motion(wheel, effects, {gap + 0.25, 0}, 10, 0.001));
  ASSERT_GT(zeros.size(), 10U);
  const double measured = (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
  EXPECT_NEAR(measured, period, kTenthOfFloorRad / speed);
}

TEST(Backlash, InTheGapOnlyTheWheelsOwnDampingActs) {
  const WheelArm wheel{0.1, 2, 20};
  const std::vector<Effect> effects{with(backlash, {{"half_gap_rad", 0.4}, {"wheel_damping_share", 0.1}})};
  const Motion motion = free_motion(wheel, effects, {-0.2, 0.5}, 0.5);
  for (std::size_t i = 0; i < motion.time_s.size(); ++i) {
    EXPECT_NEAR(motion.rate_rad_s[i], 0.5 * std::exp(-2 * motion.time_s[i]), 1e-8);
  }
}

TEST(GravityImbalance, SmallSwingsAreThoseOfAPendulum) {
  // th'' = -(C + m g r cos(phi)) th/J about a balance; with phi = 0 about zero. Amplitude 0.01: the pendulum's own
  // lengthening is A^2/16, 6e-6 of the period.
  const WheelArm wheel{0.1, 0, 5};
  const std::vector<Effect> effects{with(gravity_imbalance, {{"weight_torque_nm", 3}, {"phase_rad", 0}})};
  const auto zeros = upward_zeros(free_motion(wheel, effects, {0.01, 0}, 20, 0.001));
  const double measured = (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
  EXPECT_NEAR(measured, kTwoPi / std::sqrt(80), 2e-5);
}

TEST(TorqueRipple, SlidesDownItsOwnPotential) {
  // Without spring and damping the energy J w^2/2 - (A/n) cos(n th) stays.
  const WheelArm wheel{0.1, 0, 0};
  const std::vector<Effect> effects{with(torque_ripple, {{"ripple_nm", 0.5}, {"cycles_per_turn", 10}})};
  const Motion motion = free_motion(wheel, effects, {0, 1.5}, 10);
  const auto energy = [&](std::size_t i) {
    return 0.05 * motion.rate_rad_s[i] * motion.rate_rad_s[i] - 0.05 * std::cos(10 * motion.angle_rad[i]);
  };
  for (std::size_t i = 0; i < motion.time_s.size(); ++i) EXPECT_NEAR(energy(i), energy(0), 2e-6) << i;
}

TEST(Compliance, RingsAtTheTwoModesOfItsMatrix) {
  const WheelArm wheel{0.1, 0, 20};
  const double k = 150;
  const double share = 0.25;
  const std::vector<Effect> effects{with(
      compliance, {{"grip_stiffness_nm_per_rad", k}, {"grip_damping_nms_per_rad", 0}, {"wheel_inertia_share", share}})};
  // Mass-normalised stiffness of the two-mass system: its eigenvalues are the squared mode frequencies.
  const double jw = share * 0.1;
  const double ja = 0.1 - jw;
  Eigen::Matrix2d stiffness;
  stiffness << k / jw, -k / std::sqrt(jw * ja), -k / std::sqrt(jw * ja), (k + 20) / ja;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> modes(stiffness);
  // From rest at th = A, arm at A k/(k + C), the motion is a sum of two cosines: project onto the modes.
  const double start = 0.1;
  const Eigen::Vector2d initial(start * std::sqrt(jw), start * k / (k + 20) * std::sqrt(ja));
  const Eigen::Vector2d weights = modes.eigenvectors().transpose() * initial;
  const Motion motion = free_motion(wheel, effects, {start, 0}, 5);
  for (std::size_t i = 0; i < motion.time_s.size(); ++i) {
    double expected = 0;
    for (int m = 0; m < 2; ++m) {
      expected +=
          modes.eigenvectors()(0, m) * weights(m) * std::cos(std::sqrt(modes.eigenvalues()(m)) * motion.time_s[i]);
    }
    EXPECT_NEAR(motion.angle_rad[i], expected / std::sqrt(jw), kTenthOfFloorRad) << i;
  }
}

TEST(HandsOff, LeavesTheWheelAloneAndGivesTheArmBack) {
  const WheelArm wheel{0.1, 2, 20};
  const std::vector<Effect> effects{with(hands_off, {{"period_s", 2},
                                                     {"away_s", 0.5},
                                                     {"first_s", 0.253},
                                                     {"wheel_inertia_share", 0.3},
                                                     {"wheel_damping_share", 0.1}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0.253, {0.1, 0.4});  // the hand leaves now
  const double rate = 0.2 / 0.03;
  for (int i = 1; i <= 50; ++i) {
    plant.advance({7, 0, 0, 0}, {0.1, 0, 0, 0}, 0.01);  // the driver's torque is away with the hand
    const double decay = std::exp(-rate * 0.01 * i);
    const double terminal = -0.1 / 0.2;
    EXPECT_NEAR(plant.state().rate_rad_s, terminal + (0.4 - terminal) * decay, 1e-7);
  }
  const WheelState back = plant.state();
  Plant whole({}, {.wheel = wheel});
  whole.start(0, back);
  for (int i = 0; i < 100; ++i) {
    plant.advance({7, 0, 0, 0}, {0.1, 0, 0, 0}, 0.01);
    whole.advance({7, 0, 0, 0}, {0.1, 0, 0, 0}, 0.01);
    EXPECT_NEAR(plant.state().angle_rad, whole.state().angle_rad, kTenthOfFloorRad);
  }
}

/// J alone while the hand fades: J (q + (1 - q) e^(-t/f)) th'' = -T, so th' = -T f/(J q) log(q e^(t/f) + 1 - q).
TEST(HandsOff, FadesAsALagOfFirstOrder) {
  constexpr double kInertia = 0.1;
  constexpr double kShare = 0.3;
  constexpr double kFade_s = 0.08;
  const std::vector<Effect> effects{with(
      hands_off,
      {{"period_s", 100}, {"away_s", 50}, {"first_s", 1.003}, {"wheel_inertia_share", kShare}, {"fade_s", kFade_s}})};
  Plant plant(effects, {.wheel = {kInertia, 0, 0}});
  plant.start(1.003, {});
  for (int i = 1; i <= 100; ++i) {
    plant.advance({}, {0.1, 0, 0, 0}, 0.01);
    const double rate =
        -0.1 * kFade_s / (kInertia * kShare) * std::log(kShare * std::exp(0.01 * i / kFade_s) + 1 - kShare);
    EXPECT_NEAR(plant.state().rate_rad_s, rate, 1e-7);
  }
}

/// The share that is away, integrated in small steps from the lag's own equation, over periods so short that it never
/// settles.
TEST(HandsAway, ItsShareAndItsMeanAreThoseOfTheLag) {
  for (const double fade_s : {0.0, 0.05, 0.1}) {
    const effect::HandsAway hands(std::vector{0.5, 0.2, 0.13, 0.3, 0.05, fade_s});
    constexpr double kH_s = 1e-5;
    constexpr double kWindow_s = 0.02;
    const auto off = [](double t) { return std::fmod(t - 0.13 + 10, 0.5) < 0.2; };
    double share = 0;
    double in_window = 0;
    double before = 0;
    for (int i = 0; i < 300000; ++i) {
      const double t = i * kH_s;
      const double target = off(t + kH_s / 2) ? 1 : 0;
      before = share;
      share = fade_s > 0 ? target + (share - target) * std::exp(-kH_s / fade_s) : target;
      if (t < 2) continue;  // settled
      if (std::abs(std::remainder(t - 0.13, 0.5)) > 1e-4 && std::abs(std::remainder(t - 0.33, 0.5)) > 1e-4) {
        ASSERT_NEAR(hands.share(t, t), before, 1e-6) << fade_s << " at " << t;
      }
      in_window += share * kH_s;
      if ((i + 1) % 2000 == 0) {
        ASSERT_NEAR(hands.mean_share(t + kH_s - kWindow_s / 2, kWindow_s), in_window / kWindow_s, 1e-3) << fade_s;
        in_window = 0;
      }
    }
  }
}

/// The sensor sees what the hand still applies.
TEST(HandsOff, TheRecordedTorqueFadesWithTheHand) {
  const std::vector<Effect> effects{
      with(hands_off, {{"period_s", 20}, {"away_s", 1}, {"first_s", 2}, {"fade_s", 0.1}})};
  Recorder recorder(effects, {});
  for (const auto& [time_s, left] : {std::pair{1.9, 1.0}, {2.1, std::exp(-1.0)}, {3.1, 1 - std::exp(-1.0)}}) {
    Channels now{.time_s = time_s, .torque_driver_nm = 3, .torque_motor_nm = 2, .angle_rad = 1};
    recorder.before_noise(now);
    EXPECT_NEAR(now.torque_driver_nm, 3 * left, 1e-3);
    EXPECT_EQ(now.torque_motor_nm, 2);
  }
}

TEST(TimeVaryingStiffness, StepsAndRampsWhereItSays) {
  const WheelArm wheel{0.1, 3, 20};
  for (const double shape : {0.0, 1.0}) {
    const std::vector<Effect> effects{with(
        time_varying_stiffness, {{"shape", shape}, {"stiffness_ratio", 1.5}, {"time_s", 3.004}, {"length_s", 100}})};
    Plant plant(effects, {.wheel = wheel});
    plant.start(0, {0.1, 0});
    const auto settle = [&](int ticks) {
      for (int i = 0; i < ticks; ++i) plant.advance({2, 0, 0, 0}, {}, 0.01);
      return plant.state().angle_rad;
    };
    EXPECT_NEAR(settle(300), 2 / 20.0, 1e-6);
    // The step settles; the ramp is slow enough to be followed at its lag of B/C of a second or so.
    const double part = shape == 0 ? 1 : (23.0 - 3.004) / 100;
    EXPECT_NEAR(settle(2000), 2 / (20 * (1 + 0.5 * part)), shape == 0 ? 1e-6 : 1e-4);
  }
}

/// Without a spring a damped wheel slows down as exp(-B t/J), from the step on as exp(-B ratio^exponent t/J).
TEST(TimeVaryingStiffness, TheDampingFollowsByItsExponent) {
  for (const double exponent : {0.0, 0.5, 1.0}) {
    const std::vector<Effect> effects{
        with(time_varying_stiffness, {{"stiffness_ratio", 2.25}, {"time_s", 0.104}, {"damping_exponent", exponent}})};
    Plant plant(effects, {.wheel = {0.1, 0.5, 0}});
    plant.start(0, {0, 1});
    for (int i = 0; i < 30; ++i) plant.advance({}, {}, 0.01);
    const double factor = exponent == 0 ? 1 : (exponent == 1 ? 2.25 : 1.5);
    EXPECT_NEAR(plant.state().rate_rad_s, std::exp(-5 * (0.104 + factor * 0.196)), 1e-6);
  }
}

TEST(TimeVaryingStiffness, SwingAtTwiceTheNaturalFrequencyPumpsLikeMathieu) {
  // th'' + w0^2 (1 + e sin(2 w0 t)) th = 0 grows as exp(e w0 t/4) to first order in e (Nayfeh and Mook 1979, 5.2.1).
  const WheelArm wheel{0.1, 0, 20};
  const double natural = std::sqrt(200);
  const std::vector<Effect> effects{
      with(time_varying_stiffness,
           {{"shape", 2}, {"stiffness_ratio", 1.1}, {"time_s", 0}, {"length_s", std::numbers::pi / natural}})};
  Plant plant(effects, {.wheel = wheel});
  plant.start(0, {0.01, -0.01 * natural * 0});
  const auto size = [&] { return std::hypot(plant.state().angle_rad, plant.state().rate_rad_s / natural); };
  for (int i = 0; i < 500; ++i) plant.advance({}, {}, 0.01);
  const double early = size();
  for (int i = 0; i < 500; ++i) plant.advance({}, {}, 0.01);
  EXPECT_NEAR(std::log(size() / early), 0.1 * natural * 5 / 4, 0.1);
}

TEST(Reflex, AnswersASineAsItsTransferFunctionSays) {
  // theta/T = 1/(J s^2 + B s + C + K exp(-s d)/(1 + s T + q s^2 T^2)): one lag, hardly more than one, two, and
  // Butterworth.
  const WheelArm wheel{0.1, 2, 20};
  for (const double shape : {0.0, 0.015, 0.05, 0.25, 0.5}) {
    const std::vector<Effect> effects{with(reflex, {{"reflex_stiffness_nm_per_rad", 6},
                                                    {"delay_s", 0.053},
                                                    {"time_constant_s", 0.03},
                                                    {"low_pass_shape", shape}})};
    for (const double hz : {0.3, 2.0, 4.7}) {
      const std::complex<double> s(0, kTwoPi * hz);
      const std::complex<double> low_pass = 1.0 + s * 0.03 + shape * s * s * 0.03 * 0.03;
      const std::complex<double> answer = 1.0 / (0.1 * s * s + 2.0 * s + 20.0 + 6.0 * std::exp(-s * 0.053) / low_pass);
      const Record record = stream(wheel, effects, {{{2, hz, 0}}}, {}, 20);
      for (std::size_t i = 1500; i < record.size(); ++i) {
        const double expected = 2 * std::imag(answer * std::exp(s * record.time_s[i]));
        ASSERT_NEAR(record.angle_rad[i], expected, kTenthOfFloorRad) << shape << ", " << hz << " Hz, " << i;
      }
    }
  }
}

TEST(PeriodicDisturbance, IsASineThatNobodyRecords) {
  const WheelArm wheel{0.1, 2, 20};
  const std::vector<Effect> effects{
      with(periodic_disturbance, {{"amplitude_nm", 0.7}, {"frequency_hz", 3.3}, {"phase_rad", 0.4}})};
  const std::complex<double> s(0, kTwoPi * 3.3);
  const std::complex<double> answer = 0.7 * std::polar(1.0, 0.4) / (0.1 * s * s + 2.0 * s + 20.0);
  const Record record = stream(wheel, effects, {}, {}, 10);
  for (std::size_t i = 600; i < record.size(); ++i) {
    ASSERT_NEAR(record.angle_rad[i], std::imag(answer * std::exp(s * record.time_s[i])), kTenthOfFloorRad);
    ASSERT_EQ(record.torque_driver_nm[i], 0.0);
  }
}

TEST(UnmeasuredTorque, HasItsRmsAndNothingAboveOneOverItsKnots) {
  // A heavy damped wheel without inertia to speak of reads the torque off: th = T/C once the wheel is fast enough.
  const WheelArm fast{1e-4, 0.02, 1};
  const std::vector<Effect> effects{with(unmeasured_torque, {{"rms_nm", 0.4}, {"knot_interval_s", 1}})};
  const double duration = 2000;
  const Record record = stream(fast, effects, {}, {}, duration, {}, 7);
  // 2000 independent coefficients: their mean square is known to within sqrt(0.8/2000) = 2 %, its root to 1 %; 4 sigma.
  EXPECT_NEAR(rms(record.angle_rad), 0.4, 0.016);
  // Spectrum falls as sinc^4: at 1, 2 and 1.5 Hz at most (2/(3 pi))^4 = 2e-3 of the amplitude density at zero.
  const auto line = [&](double hz) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < record.size(); ++i)
      sum += record.angle_rad[i] * std::polar(1.0, -kTwoPi * hz * record.time_s[i]);
    return std::abs(sum) / static_cast<double>(record.size());
  };
  const double low = line(0.05) + line(0.1) + line(0.15) + line(0.2);
  EXPECT_LT(line(1.0) + line(1.5) + line(2.0), 0.02 * low);
}

TEST(UnmeasuredTorque, FollowsAGivenTimeCourseAndIsSilentInAReplayWithoutOne) {
  const WheelArm wheel{0.1, 2, 20};
  Effect effect(unmeasured_torque);
  Plant silent(std::span(&effect, 1), {.wheel = wheel, .replay = true, .seed = 3});
  silent.start(0, {0, 0});
  for (int i = 0; i < 1000; ++i) silent.advance({}, {}, 0.01);
  EXPECT_EQ(silent.state().angle_rad, 0.0);

  effect.time_course_nm.assign(30, 1.5);  // a B-spline of equal coefficients is that constant
  Plant given(std::span(&effect, 1), {.wheel = wheel, .replay = true});
  given.start(0, {0, 0});
  for (int i = 0; i < 1500; ++i) given.advance({}, {}, 0.01);
  EXPECT_NEAR(given.state().angle_rad, 1.5 / 20, 1e-6);
}

}  // namespace
}  // namespace steerid::test
