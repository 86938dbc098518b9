// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whole diagnosis on drives whose cause is known, made by a route of their own (gap/drawn_drive.hpp), and on
// records from which nothing can be told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "gap/consistent_answer.hpp"
#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/diagnosis_json.hpp"
#include "gap/drawn_drive.hpp"
#include "gap/likeliest_changes.hpp"
#include "log/bad_input.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

void expect_consistent(const Diagnosis& diagnosis) {
  EXPECT_TRUE(test::is_consistent(diagnosis));
  EXPECT_EQ(diagnosis.ranking.size(), 25U);  // none, parameters, 22 effects, unknown
  // The verdict is the change that closes most; another one may be as sure.
  const auto verdict = std::ranges::find(diagnosis.ranking, diagnosis.verdict, &RankedEffect::id);
  EXPECT_GT(verdict->probability, 0.8 * diagnosis.ranking.front().probability);
  EXPECT_EQ(diagnosis_json(diagnosis).at("schema"), "steerid.diagnosis/1");
  const std::string with_effect = diagnosis.with_effect.to_json();
  EXPECT_EQ(Simulation::from_json(with_effect, "sim_with_effect.json").to_json(), with_effect);
}

TEST(Diagnose, DryFrictionIsNamedAndClosesTheGap) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.3;
  const Record record = test::drive(what, test::seed(41));
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "coulomb_friction");
  ASSERT_EQ(diagnosis.causes.size(), 1U);
  EXPECT_NEAR(diagnosis.causes[0].effect.at("friction_nm"), 0.3, 0.015);
  EXPECT_GT(diagnosis.gap.closed_fraction.value, 0.9);
  EXPECT_LT(diagnosis.gap.closed_fraction.value, 1.1);
  EXPECT_NEAR(diagnosis.base.inertia_kgm2.value, 0.11, 0.02 * 0.11);
  EXPECT_NEAR(diagnosis.base.damping_nms_per_rad.value, 1.5, 0.03 * 1.5);
  // What replays is what was reported.
  const std::vector<double> again = free_run(diagnosis.with_effect, record);
  EXPECT_EQ(again.size(), diagnosis.series.with_effect_rad.size());
  EXPECT_EQ(again[1234], diagnosis.series.with_effect_rad[1234]);
}

TEST(Diagnose, DryFrictionThatBendsIsFoundWithWhatItBendsBy) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.5;
  what.bristle_rad = 6e-4;  // the angle's noise
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(55)), test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "coulomb_friction");
  ASSERT_EQ(diagnosis.causes.size(), 1U);
  // Ideal friction in its place is found some 5 % too small, and closes nine tenths.
  EXPECT_NEAR(diagnosis.causes[0].effect.at("friction_nm"), 0.5, 0.005);
  EXPECT_NEAR(diagnosis.causes[0].effect.at("bristle_rad"), 6e-4, 6e-5);
  EXPECT_GT(diagnosis.gap.closed_fraction.value, 0.97);
  EXPECT_LT(diagnosis.gap.closed_fraction.value, 1.05);
}

TEST(Diagnose, HardeningSpringIsNamedWithItsSize) {
  test::DrawnDrive what;
  what.torque = [](double, double x, double) { return -60 * x * x * x; };
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(42)), test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "cubic_stiffness");
  ASSERT_FALSE(diagnosis.causes.empty());
  EXPECT_NEAR(diagnosis.causes[0].effect.values[0], 60, 6);
}

TEST(Diagnose, ALagThatTheLibraryLacksIsADelayOrUnknown) {
  // Two responses of low order come close to any other: a delay beside a compliance reaches the noise level here, and
  // nothing in the record tells them from the lag.
  test::DrawnDrive what;
  what.lag_s = 0.02;
  const Record record = test::drive(what, test::seed(57));
  const Simulation simulation = test::off_by_five_percent(what.wheel);
  EXPECT_EQ(diagnose(record, simulation).verdict, "lag");
  DiagnoseOptions options;
  options.without = {"lag"};
  const std::string verdict = diagnose(record, simulation, options).verdict;
  EXPECT_TRUE(verdict == "delay" || verdict == "unknown") << verdict;
}

TEST(Diagnose, TwoEffectsOfLikeSizeAreBothNamed) {
  // Neither reaches the floor alone: a late angle in a drag that grows with the square of the rate.
  test::DrawnDrive what;
  what.delay_s = 0.02;
  what.torque = [](double, double, double v) { return -1.2 * std::abs(v) * v; };
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(49)), test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  ASSERT_EQ(diagnosis.causes.size(), 2U);
  EXPECT_FALSE(diagnosis.surrogate);
  EXPECT_EQ(diagnosis.verdict, diagnosis.causes[0].effect.type->id);
  for (const Cause& cause : diagnosis.causes) {
    const bool late = cause.effect.type == &effect::delay;
    ASSERT_TRUE(late || cause.effect.type == &effect::quadratic_damping) << cause.effect.type->id;
    // Four standard deviations, as the intervals state them; a cause that is named twice leaves the other out.
    const double truth = late ? 0.02 : 1.2;
    const double sd = (cause.parameters[0].high - cause.parameters[0].low) / (2 * 1.96);
    EXPECT_NEAR(cause.effect.values[0], truth, 4 * sd);
    EXPECT_LT(sd, 0.1 * truth);
  }
  EXPECT_NE(diagnosis.causes[0].effect.type, diagnosis.causes[1].effect.type);
  EXPECT_NEAR(diagnosis.gap.closed_fraction.value, 1, 0.1);
}

TEST(Diagnose, HandsOffDoesNotHideAnOffset) {
  // hands_off is nearly all of the gap, 0.1 % of which the offset is.
  test::DrawnDrive what;
  what.away = [](double t) { return std::fmod(t + 2, 13.3) < 0.25; };
  Record record = test::drive(what, test::seed(59));
  for (double& torque : record.torque_driver_nm) torque += 0.5;
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(test::likeliest_changes(diagnosis), (std::vector<std::string>{"hands_off", "torque_bias"}));
  ASSERT_EQ(diagnosis.causes.size(), 2U);
  for (const Cause& cause : diagnosis.causes) {
    if (cause.effect.type != &effect::torque_bias) continue;
    EXPECT_NEAR(cause.effect.at("bias_nm"), 0.5, 0.02);
  }
}

TEST(Diagnose, AToneThatIsMoreThanADriversSlowTorqueIsNamed) {
  // 3 % of the applied torque: more than the 2 % of any colour that every driver adds, less than the 5 % of a cause.
  test::DrawnDrive what;
  const double amplitude_nm = 0.03 * what.probe_rms_nm * std::numbers::sqrt2;
  what.torque = [=](double t, double, double) { return amplitude_nm * std::sin(2 * std::numbers::pi * 0.79 * t); };
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(60)), test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "periodic_disturbance");
}

TEST(Diagnose, ADriversTorqueThatItsSensorReadsTooLowIsNoUnmeasuredTorque) {
  // The driver steers slowly, below 0.5 Hz, and the sensor reads two thirds of it. What is missing is a slow torque,
  // and would be an unmeasured one if it did not follow the recorded torque.
  test::DrawnDrive what;
  const auto steering = [](double t) {
    return 1.2 * std::cos(1.3 * t) + 1.0 * std::cos(2.1 * t + 1) + 0.8 * std::cos(2.9 * t + 2);
  };
  what.torque = [&](double t, double, double) { return steering(t); };
  Record record = test::drive(what, test::seed(50));
  constexpr double kSettled_s = 3;  // the drive's time runs from before the record
  for (std::size_t i = 0; i < record.size(); ++i) {
    record.torque_driver_nm[i] += 2.0 / 3 * steering(record.time_s[i] + kSettled_s);
  }
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "unknown");
}

TEST(Diagnose, ASlowTorqueThatNobodyMeasuredReplaysAsItWasReported) {
  test::DrawnDrive what;
  what.torque = [](double t, double, double) {
    return 0.5 * (std::cos(0.9 * t) + std::cos(1.7 * t + 1) + std::cos(3.1 * t + 2));
  };
  const Record record = test::drive(what, test::seed(58));
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "unmeasured_torque");
  // Its rms, 0.5 sqrt(3 / 2) Nm: the size of a colour that is not its own, known to a fifth.
  EXPECT_NEAR(diagnosis.causes.front().effect.at("rms_nm"), 0.61, 0.12);
  const Simulation read = Simulation::from_json(diagnosis.with_effect.to_json(), "sim_with_effect.json");
  const std::vector<double> again = free_run(read, record);
  ASSERT_EQ(again.size(), diagnosis.series.with_effect_rad.size());
  for (std::size_t i = 0; i < again.size(); ++i) ASSERT_EQ(again[i], diagnosis.series.with_effect_rad[i]) << i;
}

TEST(Diagnose, HandsOffInTheHeldOutPartAloneIsFound) {
  test::DrawnDrive what;
  what.away = [](double t) {
    constexpr double kSettled_s = 3;  // the drive's time runs from before the record
    return t > 16.2 + kSettled_s && t < 16.7 + kSettled_s;
  };
  Record record = test::drive(what, test::seed(59));
  const std::vector<Block> blocks = held_out_split(record);
  const auto held_out = std::ranges::find(blocks, Block::Role::kReport, &Block::role);
  ASSERT_LT(record.time_s[held_out->first], 16.2);
  ASSERT_GT(record.time_s[held_out->first + held_out->count - 1], 16.7);
  for (double& stamp : record.time_s) stamp += 1000;  // the answer says so, since its instants do not
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "hands_off");
  for (const std::string_view said : {"changed places", "instants of effects count from 1000 s of the log's clock"}) {
    EXPECT_TRUE(std::ranges::any_of(diagnosis.notes,
                                    [&](const std::string& note) { return note.find(said) != std::string::npos; }));
  }
}

/// Three times, of which the second falls into the held-out part: what is seen fits a hand that leaves twice as seldom,
/// and the free run then misses the second time.
TEST(Diagnose, HandsOffOnceMoreInTheHeldOutPartIsFound) {
  constexpr double kFirst_s = 3.8;
  constexpr double kPeriod_s = 21.8;
  test::DrawnDrive what;
  what.away = [](double t) {
    constexpr double kSettled_s = 3;  // the drive's time runs from before the record
    const double since_s = t - kSettled_s - kFirst_s;
    return since_s > 0 && std::fmod(since_s, kPeriod_s) < 0.3;
  };
  const Record record = test::drive(what, test::seed(60));
  const std::vector<Block> blocks = held_out_split(record);
  for (int k = 0; k < 3; ++k) {
    const double leave_s = kFirst_s + k * kPeriod_s;
    const auto there = std::ranges::find_if(
        blocks, [&](const Block& block) { return record.time_s[block.first + block.count - 1] > leave_s; });
    ASSERT_EQ(there->role == Block::Role::kReport, k == 1);
  }
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "hands_off");
  EXPECT_NEAR(diagnosis.causes.front().effect.at("period_s"), kPeriod_s, 0.02);
  EXPECT_LT(diagnosis.gap.with_effect_nrmse, 2 * diagnosis.gap.floor_nrmse);
}

TEST(Diagnose, ABentSpringIsNoRippleOfWhichTheWheelSeesNoCycle) {
  // The hardening spring again, by a library that lacks it. Of 20 seeds (101 to 120) 18 are unknown, with 0.94 and
  // more. In two a ripple beside a stiffness that changes is named, with 0.60.
  test::DrawnDrive what;
  what.torque = [](double, double x, double) { return -60 * x * x * x; };
  DiagnoseOptions options;
  options.without = {"cubic_stiffness"};
  const Diagnosis diagnosis =
      diagnose(test::drive(what, test::seed(42)), test::off_by_five_percent(what.wheel), options);
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "unknown");
  EXPECT_GT(diagnosis.ranking.front().probability, 0.9);
}

/// Whose weight the simulation lacks: the record shows the spring that the simulation has not, so that free runs go on
/// from block to block, and the weight is more than a spring.
TEST(Diagnose, APendulumIsRecognisedByASimulationWithoutASpring) {
  constexpr double kWeight_nm = 8;
  test::DrawnDrive what;
  what.wheel = {0.1, 0.8, 0};
  what.torque = [](double, double x, double) { return -kWeight_nm * std::sin(x); };
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(60)), test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "gravity_imbalance");
  ASSERT_FALSE(diagnosis.causes.empty());
  // At small angles a weight is a spring. Of the seeds 60 to 66 four have C above zero, and the weight up to 8 % too
  // low.
  const double weight_nm = diagnosis.causes[0].effect.at("weight_torque_nm");
  EXPECT_NEAR(weight_nm, kWeight_nm, 0.1 * kWeight_nm);
  EXPECT_NEAR(weight_nm + diagnosis.base.stiffness_nm_per_rad.value, kWeight_nm, 0.02 * kWeight_nm);
  EXPECT_TRUE(std::ranges::none_of(
      diagnosis.notes, [](const std::string& note) { return note.find("begin anew") != std::string::npos; }));
}

TEST(Diagnose, ARightSimulationHasNoGap) {
  const test::DrawnDrive what;
  Simulation simulation;
  simulation.wheel = what.wheel;
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(43)), simulation);
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "none");
  EXPECT_TRUE(diagnosis.causes.empty());
}

/// Of half of such records the fit has a C of next to nothing below zero, so that the wheel has no response to a
/// constant torque.
TEST(Diagnose, ARightSimulationWithoutASpringHasNoGap) {
  for (const std::uint64_t offset : {0U, 1U, 2U, 3U}) {
    test::DrawnDrive what;
    what.wheel = {0.05, 0.4, 0};
    what.duration_s = 30;
    Simulation simulation;
    simulation.wheel = what.wheel;
    const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(140) + offset), simulation);
    expect_consistent(diagnosis);
    EXPECT_EQ(diagnosis.verdict, "none") << "seed " << offset;
  }
}

TEST(Diagnose, WithoutASpringFrictionAndADelayAreNamed) {
  test::DrawnDrive what;
  what.wheel = {0.05, 0.4, 0};
  what.dry_friction_nm = 0.2;
  what.delay_s = 0.015;
  Simulation simulation;
  simulation.wheel = what.wheel;
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(145)), simulation);
  expect_consistent(diagnosis);
  ASSERT_EQ(diagnosis.causes.size(), 2U);
  for (const Cause& cause : diagnosis.causes) {
    EXPECT_GT(cause.probability, 0.9);
    const bool late = cause.effect.type == &effect::delay;
    EXPECT_NEAR(cause.effect.values[0], late ? 0.015 : 0.2, late ? 0.0005 : 0.01) << cause.effect.type->id;
  }
  EXPECT_GT(diagnosis.gap.closed_fraction.value, 0.9);
}

TEST(Diagnose, ALoudTorqueSensorDroveNoWheel) {
  // Behind a quiet angle the torque's noise is nearly all that is left: whatever lets less of it through would gain.
  test::DrawnDrive what;
  what.torque_noise_nm = 0.06;
  what.angle_noise_rad = 0.00012;
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(49)), test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "parameters");
}

TEST(Diagnose, AWrongStiffnessIsParameters) {
  const test::DrawnDrive what;
  Simulation simulation;
  simulation.wheel = {0.11, 1.5, 16};
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(44)), simulation);
  EXPECT_EQ(diagnosis.verdict, "parameters");
  EXPECT_NEAR(diagnosis.base.stiffness_nm_per_rad.value, 22.7, 0.2);
}

TEST(Diagnose, DampingThatGrowsWithTheAngleIsUnknown) {
  // In no vocabulary: B (1 + (x/0.06)^2), half as much again in the mean.
  test::DrawnDrive what;
  what.torque = [](double, double x, double v) { return -3.0 * v * std::pow(x / 0.06, 2); };
  const Diagnosis diagnosis = diagnose(test::drive(what, test::seed(45)), test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "unknown");
  EXPECT_EQ(diagnosis.surrogate, !diagnosis.causes.empty());
  EXPECT_LE(diagnosis.gap.with_effect_nrmse, diagnosis.gap.refit_nrmse) << "a surrogate that is worse than none";
}

/// The samples of `record` that `keep` wants.
template <typename Keep>
Record kept_of(const Record& record, const Keep& keep) {
  Record out;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!keep(i, record.time_s[i])) continue;
    out.time_s.push_back(record.time_s[i]);
    out.torque_driver_nm.push_back(record.torque_driver_nm[i]);
    out.torque_motor_nm.push_back(record.torque_motor_nm[i]);
    out.angle_rad.push_back(record.angle_rad[i]);
  }
  return out;
}

TEST(Diagnose, TheSameFrictionIsFoundInShortSlowAndBrokenRecords) {
  test::DrawnDrive what;
  what.dry_friction_nm = 0.4;
  const Record record = test::drive(what, test::seed(48));
  const struct {
    const char* name;
    Record record;
    double tolerance_nm;  // some three standard deviations, which grow as the record shrinks
  } cases[] = {
      {"eight seconds", kept_of(record, [](std::size_t, double t) { return t < 8; }), 0.04},
      {"50 Hz", kept_of(record, [](std::size_t i, double) { return i % 2 == 0; }), 0.02},
      {"gaps", kept_of(record, [](std::size_t, double t) { return !(t > 10 && t < 12) && !(t > 25 && t < 33); }), 0.02},
  };
  for (const auto& one : cases) {
    const Diagnosis diagnosis = diagnose(one.record, test::off_by_five_percent(what.wheel));
    EXPECT_EQ(diagnosis.verdict, "coulomb_friction") << one.name;
    ASSERT_FALSE(diagnosis.causes.empty()) << one.name;
    EXPECT_NEAR(diagnosis.causes[0].effect.values[0], 0.4, one.tolerance_nm) << one.name;
  }
}

TEST(Diagnose, RefusesWhatSaysNothing) {
  test::DrawnDrive what;
  what.duration_s = 20;
  const Record record = test::drive(what, test::seed(46));
  Simulation simulation;
  Record dead = record;
  for (double& angle : dead.angle_rad) angle = 0.25;
  EXPECT_THROW((void)diagnose(dead, simulation), BadInput);
  Record still = record;
  for (double& torque : still.torque_motor_nm) torque = 0;
  for (double& torque : still.torque_driver_nm) torque = 1;
  EXPECT_THROW((void)diagnose(still, simulation), BadInput);
  Record brief = record;
  for (auto* column : {&brief.time_s, &brief.torque_driver_nm, &brief.torque_motor_nm, &brief.angle_rad}) {
    column->resize(300);
  }
  EXPECT_THROW((void)diagnose(brief, simulation), BadInput);
}

/// What is off for a sample is no hands_off: a torque of 8 Nm, and an angle of half a radian, in one of a
/// thousand samples was called one, with a probability of 0.99 and more.
TEST(Diagnose, SpikesAreNoHandsOff) {
  const test::DrawnDrive what;
  Record record = test::drive(what, test::seed(48));
  for (std::size_t i = 400; i + 2 < record.size(); i += 1117) record.torque_driver_nm[i] += 8;
  for (std::size_t i = 900; i + 2 < record.size(); i += 1373) record.angle_rad[i] += 0.5;
  const Diagnosis diagnosis = diagnose(record, test::off_by_five_percent(what.wheel));
  expect_consistent(diagnosis);
  EXPECT_EQ(diagnosis.verdict, "parameters");
  EXPECT_NEAR(diagnosis.base.stiffness_nm_per_rad.value, 22.7, 0.005 * 22.7);
  EXPECT_TRUE(std::ranges::any_of(diagnosis.notes, [](const std::string& note) {
    return note.find("6 of torque_driver, 4 of angle") != std::string::npos;
  }));
}

TEST(Diagnose, TheSameRecordGivesTheSameAnswerOnAnyNumberOfThreads) {
  test::DrawnDrive what;
  what.duration_s = 20;
  what.dry_friction_nm = 0.3;
  const Record record = test::drive(what, test::seed(47));
  const auto text = [&](unsigned threads) {
    DiagnoseOptions options;
    options.threads = threads;
    return diagnosis_json(diagnose(record, test::off_by_five_percent(what.wheel), options)).dump();
  };
  EXPECT_EQ(text(1), text(2));
}

}  // namespace
}  // namespace steerid::gap
