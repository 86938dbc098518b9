// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What a wheel that a position loop holds can have and a free one hardly: each effect in a loop that is integrated
// here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/looped_drive.hpp"
#include "gap/preparation/driven_band.hpp"
#include "log/resample.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

using test::looped;
using test::off;
using test::PositionLoop;

constexpr double kSpring_nm_per_rad = 1.5;

/// A minute of a loop that holds a bar on a spring; `beside` is of angle and rate.
PositionLoop sprung(const std::function<double(double, double)>& beside = [](double, double) { return 0.0; }) {
  PositionLoop what;
  what.duration_s = 60;
  what.friction_nm = 0;
  what.torque = [beside](double angle, double rate) { return beside(angle, rate) - kSpring_nm_per_rad * angle; };
  return what;
}

/// The one cause that the diagnosis names. `only_the_loop_holds`: the wheel with it would not hold itself.
Cause named(const Record& record, const PositionLoop& what, const std::string& id, bool only_the_loop_holds = false) {
  const Diagnosis diagnosis = diagnose(record, off(what, kSpring_nm_per_rad));
  EXPECT_EQ(diagnosis.verdict, id);
  EXPECT_EQ(diagnosis.causes.size(), 1U);
  EXPECT_EQ(diagnosis.only_the_loop_holds, only_the_loop_holds);
  EXPECT_EQ(std::isnan(diagnosis.gap.closed_fraction.value), only_the_loop_holds);
  EXPECT_FALSE(diagnosis.next_experiment.why.empty());  // also where a free wheel would run away under every probe
  return diagnosis.causes.empty() ? Cause{} : diagnosis.causes.front();
}

TEST(LoopedWheels, AnswersAreSeenBehindADelayOnceItIsKnown) {
  PositionLoop what = sprung();
  what.angle_late_ms = 56;
  const Resampled late = resample_100hz(looped(what, test::seed(51)));
  const auto band = [&](double late_s) { return driven_band(late.record, anti_alias_for(1000).pass_hz, late_s); };
  // 56 ms turn what is answered at 18.5 Hz by 373 degrees: by its phase it takes power out at some frequencies only.
  EXPECT_FALSE(band(0).noise_alone_above);
  EXPECT_EQ(band(0).highest_hz, kHighest_hz);
  EXPECT_LE(band(0.056).highest_hz, 8);
  EXPECT_GE(band(0.056).highest_hz, 4);
}

TEST(LoopedWheels, AnAngleThatIsRecordedLateIsADelay) {
  for (const std::size_t late_ms : {20U, 56U}) {
    PositionLoop what = sprung();
    what.angle_late_ms = late_ms;
    const Cause found = named(looped(what, test::seed(52)), what, "delay");
    EXPECT_NEAR(found.effect.at("delay_s"), 0.001 * static_cast<double>(late_ms), 0.0005);
  }
}

TEST(LoopedWheels, ASpringThatWouldLetTheWheelGoIsFound) {
  // Its torque is largest at 0.058 rad and gone at 0.1 rad; the reference goes beyond.
  const double softer = 150;
  const PositionLoop what = sprung([&](double q, double) { return softer * q * q * q; });
  const Cause found = named(looped(what, test::seed(53)), what, "cubic_stiffness", true);
  EXPECT_NEAR(found.effect.at("cubic_stiffness_nm_per_rad3"), -softer, 0.05 * softer);
}

TEST(LoopedWheels, AReflexThatWouldShakeTheWheelIsFound) {
  // At 9 rad/s, where wheel and springs swing, it is 40 degrees late: K sin(40)/9 = 0.2 Nms/rad, more than the damping.
  struct Memory {
    std::deque<double> angle = std::deque<double>(500, 0.0);  // 50 ms
    double low_passed = 0;
  };
  const auto reflex = [memory = std::make_shared<Memory>()](double q, double) {
    memory->angle.push_back(q);
    memory->low_passed += 1e-4 / 0.03 * (memory->angle.front() - memory->low_passed);
    memory->angle.pop_front();
    return -3 * memory->low_passed;
  };
  const PositionLoop what = sprung(reflex);
  const Cause found = named(looped(what, test::seed(54)), what, "reflex", true);
  EXPECT_NEAR(found.effect.at("reflex_stiffness_nm_per_rad"), 3, 0.3);
}

TEST(LoopedWheels, HandsOffForASecondIsFound) {
  constexpr double kPeriod_s = 17.3;
  constexpr double kAway_s = 1.2;
  constexpr double kFirst_s = 6.1;
  constexpr double kClock_s = 500;  // the log's first stamp
  constexpr double kPause_s = 300;  // behind its first 0.1 s, which are too short for anything
  PositionLoop what = sprung();
  what.damping_nms_per_rad = 0.3;
  what.away = [](double t) { return t >= kFirst_s && std::fmod(t - kFirst_s, kPeriod_s) < kAway_s; };
  Record record = looped(what, test::seed(55));
  for (std::size_t i = 0; i < record.size(); ++i) {  // a motor's torque: it does not leave with the hand
    record.torque_motor_nm[i] = -std::exchange(record.torque_driver_nm[i], 0);
    record.time_s[i] += kClock_s + (i < 100 ? 0 : kPause_s);
  }
  const Cause found = named(record, what, "hands_off");
  // To a sample: the intervals of the answer are 0.003 s wide. The times are those of the log, of whose beginning the
  // anti-alias filter took 0.15 s.
  EXPECT_NEAR(found.effect.at("period_s"), kPeriod_s, 0.01);
  EXPECT_NEAR(found.effect.at("away_s"), kAway_s, 0.01);
  EXPECT_NEAR(std::remainder(found.effect.at("first_s") - kPause_s - kFirst_s, found.effect.at("period_s")), 0, 0.01);
  EXPECT_LT(found.effect.at("fade_s"), 0.008);  // at once
  EXPECT_NEAR(found.effect.at("wheel_inertia_share"), 0.5, 0.01);
  Simulation simulation = off(what, kSpring_nm_per_rad);
  simulation.effects = {found.effect};
  // It is simulated at the log's times as well: 3 ms later it would miss by 0.06 to 0.11, a sample later by 0.2 to 0.3.
  EXPECT_LT(diagnose(record, simulation).gap.refit_nrmse, 0.04);
}

TEST(LoopedWheels, ATorqueThatIsClippedBehindItsAnswersIs) {
  const PositionLoop what = sprung();
  Record record = looped(what, test::seed(56));
  test::Noise noise(test::seed(57));
  std::vector<double> sizes;
  for (const double torque : record.torque_driver_nm) sizes.push_back(std::abs(torque));
  std::ranges::sort(sizes);
  const double limit = sizes[sizes.size() * 9 / 10];
  for (double& torque : record.torque_driver_nm) torque = std::clamp(torque, -limit, limit) + 0.001 * noise();
  const Diagnosis diagnosis = diagnose(record, off(what, kSpring_nm_per_rad));
  EXPECT_EQ(diagnosis.verdict, "torque_saturation");
}

}  // namespace
}  // namespace steerid::gap
