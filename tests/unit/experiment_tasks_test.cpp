// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The tasks as the paper describes them, and what lies between their ticks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

#include "experiment/tasks.hpp"
#include "support/independent_wheel.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 4.5;

std::vector<TaskTorques> torques(const TaskSettings& settings, int count) {
  Task task(settings);
  std::vector<TaskTorques> out;
  for (int k = 0; k < count; ++k) out.push_back(task.next());
  return out;
}

double rms(const std::vector<TaskTorques>& run, Cubic TaskTorques::*which) {
  double squares = 0;
  for (const TaskTorques& t : run) squares += (t.*which).c0 * (t.*which).c0;
  return std::sqrt(squares / static_cast<double>(run.size()));
}

/// The wheel's angle at every tick: no code of the plant.
std::vector<double> angles(const WheelArm& arm, const std::vector<TaskTorques>& run) {
  return test::independent_angles(arm, run.size(), 10, [&](std::size_t k, double tau) {
    return (run[k].driver + run[k].unmeasured - run[k].motor).at(tau);
  });
}

TEST(Tasks, EveryTorqueIsSmoothAcrossTicks) {
  for (const TaskKind kind : kAllTasks) {
    TaskSettings settings = task_settings(kind, HandPosition::kRight3, test::seed(40));
    settings.unmeasured_percent = 5;
    const auto run = torques(settings, 3000);
    for (std::size_t k = 0; k + 1 < run.size(); ++k) {
      for (const auto which : {&TaskTorques::driver, &TaskTorques::motor, &TaskTorques::unmeasured}) {
        ASSERT_NEAR((run[k].*which).at(kTickS), (run[k + 1].*which).c0, 1e-9);
        ASSERT_NEAR((run[k].*which).slope(kTickS), (run[k + 1].*which).c1, 1e-7);
      }
    }
  }
}

TEST(Tasks, HeldMotorTorqueIsTheSmoothOneAtTheTickAndStandsStill) {
  for (const TaskKind kind : kAllTasks) {
    TaskSettings settings = task_settings(kind, HandPosition::kRight3, test::seed(41));
    const auto smooth = torques(settings, 1000);
    settings.eps = EpsTorque::kHeld;
    const auto held = torques(settings, 1000);
    for (std::size_t k = 0; k < held.size(); ++k) {
      ASSERT_EQ(held[k].motor.at(0.0), smooth[k].motor.at(0.0));
      ASSERT_EQ(held[k].motor.at(0.0099), held[k].motor.at(0.0));
      ASSERT_EQ(held[k].driver.c3, smooth[k].driver.c3);
    }
  }
}

TEST(Tasks, PassiveIsATriangleOfTenNewtonMetresPeakToPeakHeldByTheDriver) {
  const TaskSettings settings = task_settings(TaskKind::kPassive, HandPosition::kRight3, test::seed(42));
  const auto run = torques(settings, 8000);  // two periods of 40 s
  double highest = 0;
  double lowest = 0;
  std::complex<double> fundamental = 0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    highest = std::max(highest, run[k].motor.c0);
    lowest = std::min(lowest, run[k].motor.c0);
    fundamental += 2.0 / 8000 * run[k].motor.c0 * std::polar(1.0, -2 * kPi * 0.025 * static_cast<double>(k) * kTickS);
  }
  EXPECT_NEAR(highest - lowest, 10.0, 0.05);  // 0.25 % for the rounded corners
  EXPECT_NEAR(std::abs(fundamental), 8 * 5.0 / (kPi * kPi), 1e-3);
  EXPECT_LT(rms(run, &TaskTorques::driver), 0.3);  // 0.15 Nm below 0.5 Hz: some 80 independent values
  EXPECT_GT(rms(run, &TaskTorques::driver), 0.08);
  // "the value of the steering angle remains within a small range around 0": 5 Nm on 22.7 Nm/rad is 0.22 rad.
  const auto angle = angles(settings.arm, run);
  const double widest = std::abs(
      *std::max_element(angle.begin(), angle.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  EXPECT_NEAR(widest, 5.0 / 22.7, 0.04);
}

TEST(Tasks, PassiveCanCarryAProbe) {
  TaskSettings settings = task_settings(TaskKind::kPassive, HandPosition::kRight3, test::seed(43));
  const auto without = torques(settings, 4000);
  settings.probe.rms_nm = 0.5;
  const auto with = torques(settings, 4000);
  double squares = 0;
  for (std::size_t k = 0; k < with.size(); ++k) {
    const double probe = with[k].motor.c0 - without[k].motor.c0;
    squares += probe * probe;
    ASSERT_EQ(with[k].driver.c0, without[k].driver.c0);
  }
  EXPECT_NEAR(std::sqrt(squares / 4000), 0.5, 1e-9);  // four whole periods
}

TEST(Tasks, ProbeIsOneAndAHalfNewtonMetresFromTheMotor) {
  const auto run = torques(task_settings(TaskKind::kProbe, HandPosition::kRight12, test::seed(44)), 4000);
  EXPECT_NEAR(rms(run, &TaskTorques::motor), 1.5, 1e-9);
  EXPECT_LT(rms(run, &TaskTorques::driver), 0.3);
  EXPECT_EQ(rms(run, &TaskTorques::unmeasured), 0.0);
}

/// Ticks at which the angle passes zero upwards, to a fraction of a tick.
std::vector<double> upward_crossings(const std::vector<double>& angle) {
  std::vector<double> out;
  for (std::size_t k = 1; k < angle.size(); ++k) {
    if (angle[k - 1] < 0 && angle[k] >= 0) {
      out.push_back(static_cast<double>(k) - angle[k] / (angle[k] - angle[k - 1]));
    }
  }
  return out;
}

TEST(Tasks, ActiveSteersAboutSixtyDegreesAtAQuarterHertzAndNeverTheSameTwice) {
  for (const HandPosition hands : kAllHandPositions) {
    const TaskSettings settings = task_settings(TaskKind::kActive, hands, test::seed(45));
    auto angle = angles(settings.arm, torques(settings, 60'000));
    angle.erase(angle.begin(), angle.begin() + 400);  // the driver starts smoothly over 2 s
    const auto crossings = upward_crossings(angle);
    const auto cycles = crossings.size() - 1;
    // 4 s a cycle; at either end of the 147 or so cycles the phase wanders with an rms of 0.42 rad.
    const double mean_period_s = (crossings.back() - crossings.front()) * kTickS / static_cast<double>(cycles);
    ASSERT_GT(cycles, 140U);
    EXPECT_NEAR(mean_period_s, 4.0, 4.0 * kSigmas * 0.42 * std::numbers::sqrt2 / (2 * kPi) / 140.0);
    std::vector<double> amplitude;
    for (std::size_t c = 0; c < cycles; ++c) {
      const auto from = angle.begin() + static_cast<std::ptrdiff_t>(crossings[c]);
      const auto to = angle.begin() + static_cast<std::ptrdiff_t>(crossings[c + 1]);
      amplitude.push_back((*std::max_element(from, to) - *std::min_element(from, to)) / 2);
    }
    double mean = 0;
    for (const double a : amplitude) mean += a / static_cast<double>(cycles);
    double spread = 0;
    for (const double a : amplitude) spread += (a - mean) * (a - mean) / static_cast<double>(cycles - 1);
    // 1 rad, spread 6 % plus what corrections add; a correlation time of 1/(pi 0.03 Hz) leaves some 60 independent
    // amplitudes in 600 s. Corrections raise half the peak-to-peak value by up to two of their own standard deviations.
    EXPECT_NEAR(mean, 1.0, kSigmas * 0.06 / std::sqrt(60.0) + 0.04);
    EXPECT_GT(std::sqrt(spread), 0.03);
    EXPECT_LT(std::sqrt(spread), 0.12);

    // Any two cycles, laid over each other from their zero crossings, differ by far more than rounding.
    double nearest = 1e9;
    for (std::size_t a = 0; a < cycles; ++a) {
      for (std::size_t b = a + 1; b < cycles; ++b) {
        double squares = 0;
        for (int i = 0; i < 390; ++i) {
          const double d = angle[static_cast<std::size_t>(crossings[a]) + static_cast<std::size_t>(i)] -
                           angle[static_cast<std::size_t>(crossings[b]) + static_cast<std::size_t>(i)];
          squares += d * d;
        }
        nearest = std::min(nearest, std::sqrt(squares / 390));
      }
    }
    EXPECT_GT(nearest, 0.005) << "two cycles are alike within 0.3 degrees";
  }
}

TEST(Tasks, ActiveIsAssistedByATenthOfTheDriversTorque) {
  const auto run = torques(task_settings(TaskKind::kActive, HandPosition::kRight3, test::seed(46)), 1000);
  for (const TaskTorques& t : run) ASSERT_NEAR(t.motor.c0, -0.1 * t.driver.c0, 1e-12);
}

TEST(Tasks, UnmeasuredTorqueIsAShareOfWhatIsAppliedAndSlow) {
  for (const TaskKind kind : kAllTasks) {
    TaskSettings settings = task_settings(kind, HandPosition::kRight3, test::seed(47));
    settings.unmeasured_percent = 5;
    // Four hours: the square of the process has an integral correlation time of 5/(2 w0), w0 = 2 pi 0.3 Hz, so this
    // holds 10,800 independent values.
    constexpr int kCount = 1'440'000;
    Task task(settings);
    double unmeasured = 0;
    double applied = 0;
    double slope = 0;
    for (int k = 0; k < kCount; ++k) {
      const TaskTorques t = task.next();
      unmeasured += t.unmeasured.c0 * t.unmeasured.c0;
      slope += t.unmeasured.c1 * t.unmeasured.c1;
      const double net = t.driver.c0 - t.motor.c0;
      applied += net * net;
    }
    EXPECT_NEAR(std::sqrt(unmeasured / kCount) / task.applied_rms_nm(), 0.05, 0.05 * kSigmas * std::sqrt(0.5 / 10'800));
    // Its mean frequency, rms slope over rms, is the corner.
    EXPECT_NEAR(std::sqrt(slope / unmeasured) / (2 * kPi), 0.3, 0.02);
    // What is stated as applied leaves out the driver's restlessness (0.15 Nm), corrections (3 %) and spread (6 %).
    EXPECT_NEAR(std::sqrt(applied / kCount) / task.applied_rms_nm(), 1.0, 0.015) << name(kind);
  }
}

TEST(Tasks, RepeatFromTheirSeedAndDifferWithoutIt) {
  for (const TaskKind kind : kAllTasks) {
    const std::uint64_t seed = test::seed(48);
    const auto a = torques(task_settings(kind, HandPosition::kBoth3And9, seed), 500);
    const auto b = torques(task_settings(kind, HandPosition::kBoth3And9, seed), 500);
    const auto c = torques(task_settings(kind, HandPosition::kBoth3And9, seed + 1), 500);
    bool differs = false;
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_EQ(a[k].driver.c0, b[k].driver.c0);
      ASSERT_EQ(a[k].motor.c3, b[k].motor.c3);
      differs = differs || a[k].driver.c0 != c[k].driver.c0;
    }
    EXPECT_TRUE(differs);
  }
}

TEST(HandPositions, CarryTheNominalRowsOfThePapersTables) {
  const auto expect = [](TaskKind task, HandPosition hands, double j, double b, double c) {
    const WheelArm arm = nominal_arm(task, hands);
    EXPECT_EQ(arm.inertia_kgm2, j);
    EXPECT_EQ(arm.damping_nms_per_rad, b);
    EXPECT_EQ(arm.stiffness_nm_per_rad, c);
  };
  expect(TaskKind::kPassive, HandPosition::kRight3, 0.11, 1.5, 22.7);
  expect(TaskKind::kPassive, HandPosition::kRight12, 0.11, 2.1, 45.9);
  expect(TaskKind::kPassive, HandPosition::kRight130, 0.11, 0.7, 17.0);
  expect(TaskKind::kActive, HandPosition::kRight3, 0.11, 2.9, 10.2);
  expect(TaskKind::kActive, HandPosition::kRight12, 0.11, 3.0, 9.2);
  expect(TaskKind::kActive, HandPosition::kRight130, 0.11, 3.1, 10.0);
  expect(TaskKind::kProbe, HandPosition::kRight12, 0.11, 2.1, 45.9);
}

TEST(HandPositions, BothArmsAreHeavierStifferAndFasterThanOne) {
  // Section VI.C of the paper, and the ranges of its tables.
  const HandPosition pairs[3][2] = {{HandPosition::kRight3, HandPosition::kBoth3And9},
                                    {HandPosition::kRight12, HandPosition::kBoth12And6},
                                    {HandPosition::kRight130, HandPosition::kBoth10And10}};
  for (const TaskKind task : kAllTasks) {
    for (const auto& [one_hand, two_hands] : pairs) {
      const WheelArm one = nominal_arm(task, one_hand);
      const WheelArm both = nominal_arm(task, two_hands);
      EXPECT_GT(both.inertia_kgm2, one.inertia_kgm2);
      EXPECT_GT(both.stiffness_nm_per_rad, one.stiffness_nm_per_rad);
      EXPECT_GT(both.stiffness_nm_per_rad / both.inertia_kgm2, one.stiffness_nm_per_rad / one.inertia_kgm2);
      EXPECT_LE(both.inertia_kgm2, 0.18);
      EXPECT_LE(both.damping_nms_per_rad, 4.4);
      EXPECT_LE(both.stiffness_nm_per_rad, 80.5);
    }
  }
}

}  // namespace
}  // namespace steerid
