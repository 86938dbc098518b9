// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The hypotheses, one by one: what they say of themselves is true.
#include "gap/hypotheses/hypotheses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include "gap/drawn_drive.hpp"
#include "gap/model/point.hpp"
#include "gap/model/simulated_model.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/pushed_arm.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

/// What leaks from a block's ends passes through the poles alone: with compliance, over the determinant of two masses.
TEST(Hypotheses, TheBlockEndsOfComplianceHaveItsPolesAndNotItsZeros) {
  const WheelArm wheel{0.14, 1.2, 45};
  const double values[] = {150, 0.5, 0.25, 0.1};
  for (const auto& hypothesis : hypotheses()) {
    if (&hypothesis->type() != &effect::compliance) continue;
    for (const double w : {1.0, 17.0, 43.0, 70.0}) {
      const Complex s(0, w);
      const Complex grip = 150.0 + 0.5 * s;
      const Complex arm = 0.105 * s * s + 1.08 * s + 45.0;
      const Complex determinant = (0.035 * s * s + 0.12 * s + grip) * (arm + grip) - grip * grip;
      EXPECT_LT(std::abs(hypothesis->ends(wheel, values, w) * determinant / 45.0 - 1.0), 1e-12) << w;
      EXPECT_LT(std::abs(hypothesis->response(wheel, values, w) * determinant / (arm + grip) - 1.0), 1e-12) << w;
    }
  }
}

/// Scale and phase as a fit takes them apart: against the torque at the values themselves, worked out anew.
TEST(Hypotheses, WhatIsSaidToBeLinearIs) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(51));
  const MeasuredMotion motion = measured_motion(record, what.wheel);
  int linear_ones = 0;
  for (const auto& hypothesis : hypotheses()) {
    const Hypothesis::Linear linear = hypothesis->linear();
    if (linear.scale < 0) continue;
    ++linear_ones;
    std::vector<double> values;
    for (const Parameter& parameter : hypothesis->type().parameters) values.push_back(parameter.preset);
    const auto torque_with = [&](double scale, double phase) {
      values[static_cast<std::size_t>(linear.scale)] = scale;
      if (linear.phase >= 0) values[static_cast<std::size_t>(linear.phase)] = phase;
      std::vector<double> torque(record.size());
      hypothesis->torque(what.wheel, values.data(), record, motion, torque);
      return torque;
    };
    constexpr double kScale = 0.37;
    constexpr double kPhase = 0.9;
    const std::vector<double> whole = torque_with(kScale, kPhase);
    const std::vector<double> sine = torque_with(1, 0);
    const std::vector<double> cosine = torque_with(1, std::numbers::pi / 2);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const double sum = linear.phase < 0 ? sine[i] : std::cos(kPhase) * sine[i] + std::sin(kPhase) * cosine[i];
      ASSERT_NEAR(whole[i], kScale * sum, 1e-10) << hypothesis->type().id << " at sample " << i;
    }
  }
  EXPECT_EQ(linear_ones, 8);
}

/// A model keeps a torque as long as what it is said to depend on stays as it is.
TEST(Hypotheses, WhatATorqueIsSaidToDependOnMovesItAndNothingElse) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(55));
  const MeasuredMotion motion = measured_motion(record, what.wheel);
  for (const auto& hypothesis : hypotheses()) {
    if (!hypothesis->acts()) continue;
    std::vector<double> values;
    for (const Parameter& parameter : hypothesis->type().parameters) values.push_back(parameter.preset);
    const auto torque_of = [&](const WheelArm& wheel) {
      std::vector<double> torque(record.size());
      hypothesis->torque(wheel, values.data(), record, motion, torque);
      return torque;
    };
    const std::vector<double> torque = torque_of(what.wheel);
    // Whatever is chosen, and with all of it: a law may know what another does not, and a part of it be off.
    const auto moved_by = [&](double WheelArm::*number) {
      WheelArm other = what.wheel;
      other.*number *= 1.5;
      bool moves = torque_of(other) != torque;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const Parameter& parameter = hypothesis->type().parameters[i];
        if (!parameter.whole && parameter.preset != 0) continue;
        const double before = std::exchange(values[i], parameter.high);
        moves = moves || torque_of(other) != torque_of(what.wheel);
        values[i] = before;
      }
      return moves;
    };
    const Hypothesis::Knows knows = hypothesis->knows();
    EXPECT_EQ(moved_by(&WheelArm::inertia_kgm2), knows.inertia) << hypothesis->type().id;
    EXPECT_EQ(moved_by(&WheelArm::damping_nms_per_rad), knows.damping) << hypothesis->type().id;
    EXPECT_EQ(moved_by(&WheelArm::stiffness_nm_per_rad), knows.stiffness) << hypothesis->type().id;
    for (auto i = static_cast<std::size_t>(hypothesis->shown()); i < values.size(); ++i) {
      values[i] += hypothesis->type().parameters[i].scale;
      EXPECT_EQ(torque_of(what.wheel), torque) << hypothesis->type().id;
    }
  }
}

/// A fit's derivatives move one number after the other and come back: as if each point had a model of its own.
TEST(Hypotheses, AModelThatComesBackToAPointIsAsOneThatIsNew) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(56));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record), false);
  const auto spectrum = [](SpectralModel& model, const Eigen::VectorXd& x) {
    Spectrum residual;
    Response response;
    model.evaluate(x, residual, response);
    return residual;
  };
  for (const EffectType* other : {&effect::torque_ripple, &effect::hands_off, &effect::delay}) {
    const Point at{what.wheel, {Effect(effect::stribeck_friction), Effect(*other)}};
    const Parts parts = hypotheses_of(at.effects);
    const Eigen::VectorXd x = at.numbers();
    SpectralModel model(spectral, parts);
    const Spectrum first = spectrum(model, x);
    for (int round = 0; round < 3; ++round) {
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        Eigen::VectorXd moved = x;
        moved[i] += 1e-3 * (round + 1);
        SpectralModel anew(spectral, parts);
        ASSERT_EQ(spectrum(model, moved), spectrum(anew, moved)) << other->id << ", number " << i;
        ASSERT_EQ(spectrum(model, x), first) << other->id << ", number " << i;
      }
    }
  }
}

/// On the motion that an arm behind a gap makes with its wheel (support/pushed_arm.hpp) the torque is what the two
/// bodies' equations have beside the linear wheel's, but for the sample or two at which they meet or part.
TEST(Hypotheses, AnArmBehindAGapBalancesTheMotionThatItMakes) {
  const WheelArm wheel{0.11, 1.5, 22.7};
  constexpr double kGap_rad = 0.03;
  constexpr double kInertiaShare = 0.4;
  constexpr double kDampingShare = 0.1;
  constexpr int kEvery = 1000;
  constexpr int kSamples = 4000;
  const auto torque_nm = [](double t) { return 1.3 * std::sin(2 * t) + 1.1 * std::sin(7.3 * t) + std::sin(17 * t); };
  test::PushedArm reference{.wheel = {kInertiaShare * wheel.inertia_kgm2, kDampingShare * wheel.damping_nms_per_rad, 0},
                            .arm = {(1 - kInertiaShare) * wheel.inertia_kgm2,
                                    (1 - kDampingShare) * wheel.damping_nms_per_rad, wheel.stiffness_nm_per_rad},
                            .half_gap_rad = kGap_rad,
                            .step_s = 1e-5};
  Record record;
  MeasuredMotion motion;
  std::vector<double> expected_nm;
  int apart = 0;
  for (int i = 0; i < kSamples * kEvery; ++i) {
    const double t = (i + 0.5) * reference.step_s;
    reference.step(torque_nm(t));
    if (i % kEvery != 0) continue;
    apart += reference.touches ? 0 : 1;
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(torque_nm(t));
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(reference.angle_rad);
    motion.time_s.push_back(t);
    motion.angle_rad.push_back(reference.angle_rad);
    motion.rate_rad_s.push_back(reference.rate_rad_s);
    motion.acceleration_rad_s2.push_back(reference.acceleration_rad_s2);
    expected_nm.push_back(wheel.inertia_kgm2 * reference.acceleration_rad_s2 +
                          wheel.damping_nms_per_rad * reference.rate_rad_s +
                          wheel.stiffness_nm_per_rad * reference.angle_rad - torque_nm(t));
  }
  const std::vector<double> values = {kGap_rad, kDampingShare, kInertiaShare, 1};
  std::vector<double> found_nm(record.size());
  hypothesis_of(effect::backlash)->torque(wheel, values.data(), record, motion, found_nm);
  int off = 0;
  for (std::size_t i = 0; i < found_nm.size(); ++i) off += std::abs(found_nm[i] - expected_nm[i]) > 0.02 ? 1 : 0;
  EXPECT_GT(apart, kSamples / 10);
  EXPECT_LT(apart, kSamples * 9 / 10);
  EXPECT_LT(off, kSamples / 20);
}

/// The equations of the effects' files, written again; the stamps have a gap.
TEST(Hypotheses, TorquesOnTheMeasuredMotionFollowTheirEquations) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(52));
  MeasuredMotion motion = measured_motion(record, what.wheel);
  for (std::size_t i = 1000; i < record.size(); ++i) motion.time_s[i] += 2.345;
  struct Equation {
    const EffectType& type;
    std::vector<double> values;
    std::function<double(double time_s, double angle, double rate)> torque_nm;
  };
  const double stiffness = what.wheel.stiffness_nm_per_rad;
  const double damping = what.wheel.damping_nms_per_rad;
  const double turn = 2 * std::numbers::pi;
  const Equation equations[] = {
      {effect::cubic_stiffness, {7}, [](double, double angle, double) { return -7 * std::pow(angle, 3); }},
      {effect::quadratic_damping, {0.9}, [](double, double, double rate) { return -0.9 * rate * std::abs(rate); }},
      {effect::torque_ripple,
       {0.2, 9, 0.7},
       [](double, double angle, double) { return -0.2 * std::sin(9 * angle + 0.7); }},
      {effect::gravity_imbalance,
       {1.1, 0.4},
       [](double, double angle, double) { return -1.1 * std::sin(angle + 0.4); }},
      {effect::torque_bias, {0.3}, [](double, double, double) { return -0.3; }},
      {effect::torque_drift, {0.5, 12}, [](double t, double, double) { return -0.5 * (1 - std::exp(-t / 12)); }},
      {effect::periodic_disturbance,
       {0.6, 3.7, 0.4},
       [&](double t, double, double) { return 0.6 * std::sin(turn * 3.7 * t + 0.4); }},
      {effect::time_varying_stiffness,
       {2, 1.3, 4, 11, 0.5},
       [&](double t, double angle, double rate) {
         const double swing = 0.3 * std::sin(turn * (t - 4) / 11);
         return -swing * stiffness * angle - (std::sqrt(1 + swing) - 1) * damping * rate;
       }},
      {effect::backlash,
       {0.03, 0.2, 0.5, 0},
       [&](double, double angle, double rate) {
         const bool inside = std::abs(angle) < 0.03;
         return stiffness * (inside ? angle : std::copysign(0.03, angle)) + (inside ? 0.8 * damping * rate : 0);
       }},
  };
  std::vector<double> torque(record.size());
  for (const Equation& one : equations) {
    hypothesis_of(one.type)->torque(what.wheel, one.values.data(), record, motion, torque);
    for (std::size_t i = 0; i < torque.size(); ++i) {
      const double expected = one.torque_nm(motion.time_s[i], motion.angle_rad[i], motion.rate_rad_s[i]);
      ASSERT_NEAR(torque[i], expected, 1e-10) << one.type.id << " at sample " << i;
    }
  }
}

/// Away from 0.16 s before the record to its first sample, it gained 35 nats beside a stiffness that changes.
TEST(HandsOff, IsNoneThatIsBackBeforeTheRecordBegins) {
  const Hypothesis* hands_off = hypothesis_of(effect::hands_off);
  const Hypothesis::Usual usual{.record = {0, 80}};
  const auto is_one = [&](double period_s, double first_s) {
    const double values[] = {period_s, 0.3, first_s, 0.3, 0.05, 0.015};
    return hands_off->beyond_usual(values, usual);
  };
  EXPECT_FALSE(is_one(1000, -0.31));
  EXPECT_FALSE(is_one(1000, -0.25));  // 0.05 s of it are in the record
  EXPECT_TRUE(is_one(1000, -0.1));
  EXPECT_TRUE(is_one(1000, 40));
  EXPECT_TRUE(is_one(30, -0.31));  // it leaves again
  EXPECT_FALSE(is_one(1000, 79.9));
  EXPECT_FALSE(is_one(1000, 81));
  const double away_for_all[] = {1000, 90, 0.1, 0.3, 0.05, 0.015};
  EXPECT_FALSE(hands_off->beyond_usual(away_for_all, usual));
  const double held_at_first[] = {1000, 90, 3, 0.3, 0.05, 0.015};
  EXPECT_TRUE(hands_off->beyond_usual(held_at_first, usual));
}

/// A gap of 0.07 rad where the wheel turns 0.06 rad from end to end was 700 nats better than the truth.
TEST(Backlash, IsNoneWhoseEndsTheWheelNeverReaches) {
  const Hypothesis* backlash = hypothesis_of(effect::backlash);
  const auto is_one = [&](double half_gap_rad) {
    const double values[] = {half_gap_rad, 0.05, 0.3, 1};
    return backlash->beyond_usual(values, {.swing_rad = 0.06});
  };
  EXPECT_TRUE(is_one(0.02));
  EXPECT_FALSE(is_one(0.035));
  EXPECT_FALSE(is_one(0));
}

/// Sample by sample while the hand is away, in whatever period first_s lies; the record ends within the last one. The
/// recorded torque has gone with the hand already.
TEST(Hypotheses, HandsOffTakesTheArmInEveryPeriod) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(57));
  const MeasuredMotion motion = measured_motion(record, what.wheel);
  const double period_s = 7.3;
  const double away_s = 0.45;
  const double first_s = 16.04;  // the third in the record
  const double values[] = {period_s, away_s, first_s, 0.3, 0.05, 0};
  std::vector<double> torque(record.size(), 17.0);
  hypothesis_of(effect::hands_off)->torque(what.wheel, values, record, motion, torque);
  int away_samples = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double since_s = std::fmod(motion.time_s[i] - first_s + 10 * period_s, period_s);
    const bool near_an_end = std::min({since_s, std::abs(since_s - away_s), period_s - since_s}) < 0.011;
    if (near_an_end) continue;  // soft there
    const double arm_nm = 0.7 * what.wheel.inertia_kgm2 * motion.acceleration_rad_s2[i] +
                          0.95 * what.wheel.damping_nms_per_rad * motion.rate_rad_s[i] +
                          what.wheel.stiffness_nm_per_rad * motion.angle_rad[i];
    const bool away = since_s < away_s;
    away_samples += away ? 1 : 0;
    ASSERT_NEAR(torque[i], away ? arm_nm : 0, 1e-12) << "at sample " << i;
  }
  EXPECT_GT(away_samples, 40 * static_cast<int>(record.time_s.back() / period_s));
}

/// A ramp from 55.04 s on over 2.9 s may be a step at 57.85 s: looked for in tenths of a second, then in hundredths.
TEST(Hypotheses, AStepIsLookedForWithinAShortRamp) {
  for (const auto& hypothesis : hypotheses()) {
    if (&hypothesis->type() != &effect::time_varying_stiffness) continue;
    const auto nearest = [&](const std::vector<double>& found) {
      double least = 1e9;
      for (const std::vector<double>& one : hypothesis->missed_instants(found)) {
        EXPECT_EQ(one[0], 0);
        EXPECT_EQ(one[4], 0.5);
        least = std::min(least, std::abs(one[2] - 57.853));
      }
      return least;
    };
    EXPECT_LT(nearest({1, 1.06, 55.04, 2.93, 0.5}), 0.05);
    EXPECT_LT(nearest({0, 1.06, 57.81, 2.93, 0.5}), 0.005);
    EXPECT_TRUE(hypothesis->missed_instants({2, 1.06, 55.04, 2.93, 0.5}).empty());
    EXPECT_TRUE(hypothesis->missed_instants({1, 1.06, 55.04, 20, 0.5}).empty());
  }
}

/// A fit that begins with bristles on which the wheel swings faster than the plant integrates does not leave them.
TEST(Hypotheses, BristlesThatActAsNoneAreBegunAnew) {
  const WheelArm wheel{0.1, 2, 20};
  constexpr double kFriction_nm = 0.5;
  const auto bristle_rad = [&](double swing_hz) {
    return kFriction_nm / (wheel.inertia_kgm2 * std::pow(2 * std::numbers::pi * swing_hz, 2));
  };
  const Hypothesis& coulomb = *hypothesis_of(effect::coulomb_friction);
  const double slow = bristle_rad(95);
  EXPECT_EQ(coulomb.to_run({kFriction_nm, slow}, wheel).back(), slow);
  for (const double none : {0.0, bristle_rad(105), bristle_rad(1000)}) {
    EXPECT_NEAR(coulomb.to_run({kFriction_nm, none}, wheel).back() / bristle_rad(20), 1, 1e-9) << none;
  }
}

/// A sinusoidal motion's reflex in closed form: K/|1 + i w T - q (w T)^2|, late by w d and that number's angle.
TEST(Hypotheses, AReflexIsTriedAsTheTorqueThatItIs) {
  Record record;
  MeasuredMotion motion;
  const double w = 9;
  for (int i = 0; i < 2000; ++i) {
    record.time_s.push_back(0.01 * i);
    record.angle_rad.push_back(0);
    motion.time_s.push_back(0.01 * i);
    motion.angle_rad.push_back(0.2 * std::sin(w * 0.01 * i));
  }
  for (const double shape : {0.0, 0.4}) {
    const double values[] = {15, 0.06, 0.03, shape};
    std::vector<double> torque(record.time_s.size());
    for (const auto& hypothesis : hypotheses()) {
      if (&hypothesis->type() != &effect::reflex) continue;
      EXPECT_TRUE(hypothesis->tried_as_torque());
      hypothesis->torque({0.1, 1, 20}, values, record, motion, torque);
    }
    const std::complex<double> low_pass(1 - shape * std::pow(w * 0.03, 2), w * 0.03);
    const double size = 15 * 0.2 / std::abs(low_pass);
    for (std::size_t i = 200; i < torque.size(); ++i) {
      const double phase = w * (motion.time_s[i] - 0.06) - std::arg(low_pass);
      // The low pass by Tustin's rule: its frequency is wrong by (w h)^2/12, a tenth of a per cent.
      ASSERT_NEAR(torque[i], -size * std::sin(phase), 0.005 * size) << i;
    }
  }
}

/// A run that would take hundreds of steps a sample is as far from the record as can be, and one that a record shows is
/// not.
TEST(SimulatedModel, RefusesWhatIsTooFastToShow) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(53));
  const SpectralRecord spectral(record, what.wheel, held_out_split(record), false);
  SimulatedModel model(spectral, hypotheses_of({Effect(effect::coulomb_friction)}));
  Spectrum residual;
  Response response;
  const auto largest = [&](double inertia_kgm2) {
    Eigen::VectorXd x(5);
    x << inertia_kgm2, 1.5, 22.7, 0.1, 0;
    model.evaluate(x, residual, response);
    return residual.cwiseAbs().maxCoeff();
  };
  EXPECT_LT(largest(0.11), 10);
  EXPECT_GT(largest(0.0005), 1e5);  // 1.5 Nms/rad over it: over within 0.3 ms
}

/// What a block begins and ends with takes six numbers off its lines. Of a run that does not exist it must not take
/// what says so, even of a machine without a spring, for which a residual alike on all lines is such an end.
TEST(SimulatedModel, ARunThatDoesNotExistIsFarFromTheFloor) {
  const test::DrawnDrive what;
  const Record record = test::drive(what, test::seed(54));
  const std::vector<Block> blocks = held_out_split(record);
  for (const double stiffness : {0.0, 22.7}) {
    const WheelArm wheel{0.0005, 1.5, stiffness};  // over within 0.3 ms
    const SpectralRecord spectral(record, wheel, blocks, false);
    const Whittle whittle(spectral.spectra, NoiseFloor::of(record, what.wheel), spectral.applied_rms_nm);
    SimulatedModel model(spectral, hypotheses_of({Effect(effect::coulomb_friction)}));
    Eigen::VectorXd x(5);
    x << wheel.inertia_kgm2, wheel.damping_nms_per_rad, stiffness, 0.1, 0;
    const std::vector<Fitted> fitted = fitted_parameters(wheel, hypotheses_of({Effect(effect::coulomb_friction)}));
    const Whittle::Fit fit = whittle.judge(model, x, fitted, {Block::Role::kFit}, SlowTorque::kFloor);
    EXPECT_GT(fit.excess({Block::Role::kFit}), 1e3) << stiffness;
  }
}

}  // namespace
}  // namespace steerid::gap
