// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The slow torque in a run, against the one that moved the drawn wheel (gap/drawn_drive.hpp).
#include "gap/model/slow_course.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "gap/compared_drive.hpp"
#include "gap/model/simulated_model.hpp"
#include "gap/model/slow_torque.hpp"
#include "plant/effects/vocabulary.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

constexpr int kRounds = 4;
constexpr double kSettle_s = 3;  // of a drawn drive, before its record begins

/// A wheel that sticks again and again, and a torque that no sensor sees and that decides when it leaves.
class StickingWheel : public ::testing::Test {
 protected:
  static constexpr double kTimes = 3;  // the usual unseen torque
  static double slow_nm(double t) { return kTimes * test::unseen_nm(t); }

  static test::DrawnDrive what(double friction_nm) {
    test::DrawnDrive drive;
    drive.angle_noise_rad = 0.0004;
    drive.dry_friction_nm = friction_nm;
    drive.torque = [](double t, double, double) { return slow_nm(t); };
    return drive;
  }

  struct Case : test::ComparedDrive {
    explicit Case(double friction_nm, std::uint64_t seed) : Case(what(friction_nm), seed) {}
    Case(const test::DrawnDrive& what, std::uint64_t seed)
        : ComparedDrive(what, seed),
          prior{.rms_nm = 0.05 * spectral.applied_rms_nm,
                .angle_variance_rad2 = drive.angle_noise_rad * drive.angle_noise_rad} {}
    [[nodiscard]] Point truth() const {
      Effect friction(effect::coulomb_friction);
      friction.at("friction_nm") = drive.dry_friction_nm;
      return {drive.wheel, {friction}};
    }
    SlowPrior prior;
  };

  /// rms of the angle beyond a run, over the whole record.
  static double left_rad(const Record& record, std::span<const double> run) {
    double sum = 0;
    for (std::size_t i = 0; i < run.size(); ++i) sum += std::pow(record.angle_rad[i] - run[i], 2);
    return std::sqrt(sum / static_cast<double>(run.size()));
  }

  const std::uint64_t seed_ = test::seed(91);
};

TEST_F(StickingWheel, IsFollowedWhereItsPlainRunStrays) {
  const Case sticks(1.2, seed_);
  const Point truth = sticks.truth();
  const Parts parts = hypotheses_of(truth.effects);
  const auto course = std::make_shared<const SlowCourse>(slow_course(sticks.spectral, truth, sticks.prior, kRounds));
  SimulatedModel plain(sticks.spectral, parts);
  SimulatedModel with_course(sticks.spectral, parts, course);
  const double noise_rad = sticks.drive.angle_noise_rad;
  EXPECT_GT(left_rad(sticks.record, plain.run(truth)), 10 * noise_rad);
  // The angle's noise and no more than as much again: the torque's noise, and bristles that the drawn friction has not.
  const double left = left_rad(sticks.record, with_course.run(truth));
  EXPECT_LT(left, 2 * noise_rad);
  EXPECT_GT(left, 0.8 * noise_rad);
}

TEST_F(StickingWheel, TheCourseIsTheTorqueThatNobodyMeasured) {
  const Case sticks(0.3, seed_ + 1);
  const SlowCourse course = slow_course(sticks.spectral, sticks.truth(), sticks.prior, kRounds);
  const double knot_s = course.torque.at("knot_interval_s");
  double error = 0;
  double size = 0;
  // The value of the spline at a knot: (1, 4, 1)/6 of the coefficients around it.
  const std::vector<double>& c = course.torque.time_course_nm;
  for (std::size_t k = 2; k + 4 < c.size(); ++k) {
    const double found = (c[k - 1] + 4 * c[k] + c[k + 1]) / 6;
    const double truth_nm = slow_nm(static_cast<double>(k) * knot_s + kSettle_s);
    error += std::pow(found - truth_nm, 2);
    size += truth_nm * truth_nm;
  }
  // White torque noise of 0.02 Nm averaged over half a second is 0.003 Nm, a fortieth; a wheel that stands still for a
  // moment tells nothing of the torque, and the prior draws it to zero.
  EXPECT_LT(std::sqrt(error / size), 0.25);
  EXPECT_GT(std::sqrt(error / size), 0.01);
}

TEST_F(StickingWheel, WhatIsWrittenOfItReplaysSamplesThatItWasNotToldOf) {
  const Case sticks(1.2, seed_ + 3);
  Simulation simulation;
  simulation.wheel = sticks.drive.wheel;
  simulation.effects.emplace_back(effect::coulomb_friction);
  simulation.effects.back().at("friction_nm") = sticks.drive.dry_friction_nm;
  const std::vector<RunStretch> whole = {{0, sticks.record.size(), std::nullopt}};
  std::vector<double> rest = restarted_run(simulation, sticks.record, whole);
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = sticks.record.angle_rad[i] - rest[i];
  std::vector<char> use(rest.size(), 0);
  for (std::size_t i = 0; i < use.size(); i += 2) use[i] = 1;
  NoiseFloor floor;
  floor.angle_variance = sticks.prior.angle_variance_rad2;
  floor.slow_variance = sticks.prior.rms_nm * sticks.prior.rms_nm;
  const Effect linear = slow_torque(sticks.record, simulation.wheel, rest, use, floor);
  const Effect moved = slow_torque_by_runs(sticks.record, whole, simulation, linear, use, floor);
  const auto left = [&](const Effect& course) {  // over every second sample, of the angle's noise
    Simulation with = simulation;
    with.effects.push_back(course);
    const std::vector<double> run = restarted_run(with, sticks.record, whole);
    double sum = 0;
    for (std::size_t i = 1; i < run.size(); i += 2) sum += std::pow(sticks.record.angle_rad[i] - run[i], 2);
    return std::sqrt(2 * sum / static_cast<double>(run.size())) / sticks.drive.angle_noise_rad;
  };
  // Five seeds: 1.50 to 1.65, and 1.06 to 1.07, of which the torque noise is a part.
  EXPECT_GT(left(linear), 1.3);
  EXPECT_LT(left(moved), 1.2);
  EXPECT_GT(left(moved), 0.95);
}

TEST_F(StickingWheel, ALinearWheelsResidualIsThatOfItsPlainRunWhateverTheCourse) {
  const Case slides(0, seed_ + 2);
  Effect compliance(effect::compliance);
  compliance.at("grip_stiffness_nm_per_rad") = 150;
  // Linear with compliance in it, too, whose course is another one: the drawn wheel has none.
  for (const std::vector<Effect>& effects : {std::vector<Effect>{}, std::vector<Effect>{compliance}}) {
    const Point at{slides.drive.wheel, effects};
    const Parts parts = hypotheses_of(effects);
    SpectralRecord spectral = slides.spectral;  // in which all runs begin alike
    const MeasuredMotion& motion = spectral.motion;
    spectral.stretches.front().initial = WheelState{motion.angle_rad.front(), motion.rate_rad_s.front()};
    const auto course = std::make_shared<const SlowCourse>(slow_course(spectral, at, slides.prior, kRounds));
    SimulatedModel plain(spectral, parts);
    SimulatedModel with_course(spectral, parts, course);
    Spectrum as_plain;
    Spectrum as_moved;
    Response response;
    plain.evaluate(at.numbers(), as_plain, response);
    with_course.evaluate(at.numbers(), as_moved, response);
    EXPECT_GT(course->response.norm(), 0.5 * as_plain.norm());  // it took most of what was left
    // The plain wheel's run is exact from sample to sample, the other one is integrated.
    EXPECT_LT((as_moved - as_plain).norm(), 5e-4 * as_plain.norm());
  }
}

/// What a number takes over, the course gives up: against courses that are looked for anew with that number moved.
TEST_F(StickingWheel, TheCourseFollowsTheNumbersAsTheBestOneDoes) {
  const Case sticks(0.3, seed_ + 5);
  const Point truth = sticks.truth();
  const Parts parts = hypotheses_of(truth.effects);
  const SetFitter fitter(sticks.setting);
  const std::vector<Fitted> numbers = fitter.fitted(test::ComparedDrive::with(effect::coulomb_friction));
  constexpr int kMany = 12;
  const SlowCourse here = slow_course(sticks.spectral, truth, sticks.prior, kMany);
  const SlowCourse follows = following(sticks.spectral, parts, truth.numbers(), numbers, sticks.prior, here);
  const auto coefficients = [](const SlowCourse& course) {
    const std::vector<double>& c = course.torque.time_course_nm;
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(c.data(), std::ssize(c)));
  };
  constexpr std::array<std::pair<Eigen::Index, double>, 3> kSteps = {{{1, 0.05}, {2, 0.5}, {3, 0.01}}};  // of 3 %
  for (const auto& [number, step] : kSteps) {  // B, C and friction; nothing that J moves is slow
    Eigen::VectorXd x = truth.numbers();
    x[number] += step;
    const SlowCourse best = slow_course(sticks.spectral, Point::of(x, parts), sticks.prior, kMany, &here);
    const Eigen::VectorXd moved = coefficients(best) - coefficients(here);
    const Eigen::VectorXd followed = coefficients(follows.held_at(x)) - coefficients(here);
    EXPECT_LT((followed - moved).norm(), 0.5 * moved.norm()) << "number " << number;
    EXPECT_GT(followed.norm(), 0.5 * moved.norm()) << "number " << number;
  }
}

/// A fit is given a course where its wheel sticks in a torque that nobody measured, and none where it does not.
TEST_F(StickingWheel, IsGivenACourseWhereItsRunNeedsOne) {
  for (const bool moved : {true, false}) {
    test::DrawnDrive drive = what(1.2);
    if (!moved) drive.torque = [](double, double, double) { return 0.0; };
    const Case sticks(drive, seed_ + 4);
    const SetFitter fitter(sticks.setting);
    const FittedSet one =
        fitter.settled(fitter.fit(test::ComparedDrive::with(effect::coulomb_friction), sticks.truth()), 1);
    EXPECT_EQ(one.course != nullptr, moved);
  }
}

}  // namespace
}  // namespace steerid::gap
