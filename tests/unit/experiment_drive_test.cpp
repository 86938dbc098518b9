// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The driver on a whole column: the spectrum of the voluntary torque against its closed form, manoeuvres, and arms
// whose truth is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "experiment/drive_task.hpp"
#include "log/bad_input.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using std::numbers::pi;

DriveSettings settings() {
  DriveSettings drive;
  drive.arm = {0.1, 1.45, 20};
  drive.probe.rms_nm = 0;
  return drive;
}

std::vector<double> voluntary_nm(DriveSettings drive, int ticks) {
  DriveTask task(drive, Column{});
  std::vector<double> torque;
  for (int i = 0; i < ticks; ++i) torque.push_back(task.next().truth.torque_driver_nm);
  return torque;
}

/// Power of `x` between two frequencies, by Welch's method: Hann windows of 4096 ticks that overlap by half.
double power_between(const std::vector<double>& x, double low_hz, double high_hz) {
  constexpr int kLength = 4096;
  const double bin_hz = 1 / (kLength * kTickS);
  double sum = 0;
  int segments = 0;
  for (std::size_t start = 0; start + kLength <= x.size(); start += kLength / 2) {
    ++segments;
    for (int k = static_cast<int>(std::ceil(low_hz / bin_hz)); k * bin_hz < high_hz; ++k) {
      double re = 0, im = 0;
      for (int i = 0; i < kLength; ++i) {
        const double window = 0.5 - 0.5 * std::cos(2 * pi * i / kLength);
        const double phase = 2 * pi * std::fmod(1.0 * k * i, kLength) / kLength;
        re += window * x[start + static_cast<std::size_t>(i)] * std::cos(phase);
        im += window * x[start + static_cast<std::size_t>(i)] * std::sin(phase);
      }
      sum += (k == 0 ? 1 : 2) * (re * re + im * im);
    }
  }
  constexpr double kWindowPower = 0.375;  // mean square of Hann's window
  return sum / segments / (kWindowPower * kLength * static_cast<double>(kLength));
}

/// Share of the power below `hz` of a process flat up to its corner and 40 dB a decade down above: the integral of
/// 4 / (pi f0) / (1 + (f / f0)^2)^2.
double share_below(double hz) {
  const double x = hz / 0.3;
  return 2 / pi * (std::atan(x) + x / (1 + x * x));
}

TEST(DriveTask, TheVoluntaryTorqueHasItsSpectrum) {
  DriveSettings drive = settings();
  drive.seed = test::seed(71);
  const std::vector<double> torque = voluntary_nm(drive, 400'000);  // 67 minutes
  const double rms_nm = 2;                                          // 0.1 rad of 20 Nm/rad
  for (const auto& [low, high, tolerance] : {std::tuple{0.05, 0.15, 0.25},
                                             {0.15, 0.3, 0.2},
                                             {0.3, 0.6, 0.15},
                                             {0.6, 1.2, 0.1},
                                             {1.2, 2.4, 0.1},
                                             {2.4, 4.8, 0.1}}) {
    const double expected = rms_nm * rms_nm * (share_below(high) - share_below(low));
    EXPECT_NEAR(power_between(torque, low, high) / expected, 1, tolerance) << low << " to " << high << " Hz";
  }
  EXPECT_GT(share_below(0.5), 0.9);
  // Its octaves at 2.4 and 4.8 Hz: 40 dB a decade are a factor of 8 in an octave's power.
  EXPECT_NEAR(power_between(torque, 1.2, 2.4) / power_between(torque, 2.4, 4.8), 8, 0.8);
}

TEST(DriveTask, ADriverWhoHoldsStillHasNone) {
  DriveSettings drive = settings();
  drive.steering_rad = 0;
  for (const double torque : voluntary_nm(drive, 3000)) ASSERT_EQ(torque, 0);
}

/// Values and slopes belong together: the angle moves by what its slopes say, to the accuracy of Simpson's rule.
TEST(Manoeuvre, MovesSmoothlyWithinItsRange) {
  struct Range {
    Manoeuvre manoeuvre;
    double least_rad, most_rad;
  };
  for (const Range& range : {Range{Manoeuvre::kLaneKeeping, 0, 0}, Range{Manoeuvre::kCurves, 0.15, 0.5},
                             Range{Manoeuvre::kLaneChanges, 0.08, 0.2}, Range{Manoeuvre::kSwerve, 0.7, 1.1}}) {
    SCOPED_TRACE(std::string(name(range.manoeuvre)));
    ManoeuvreCourse course(range.manoeuvre, test::seed(72), 9);
    std::vector<SignalPoint> points;
    for (int i = 0; i < 30'000; ++i) points.push_back(course.next());
    double farthest_rad = 0;
    double both_sides = 1;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const double moved = points[i + 1].value - points[i - 1].value;
      const double meant = kTickS / 3 * (points[i - 1].slope + 4 * points[i].slope + points[i + 1].slope);
      ASSERT_NEAR(moved, meant, 1e-4) << i;
      farthest_rad = std::max(farthest_rad, std::abs(points[i].value));
      both_sides = std::min(both_sides, points[i].value);
    }
    EXPECT_GE(farthest_rad, range.least_rad);
    EXPECT_LE(farthest_rad, range.most_rad);
    if (range.most_rad > 0) {
      EXPECT_LT(both_sides, 0);
    }
  }
}

TEST(ArmChange, GoesItsCourse) {
  const auto at = [](ArmCourse course, double time_s) {
    return ArmChange{.course = course, .stiffness_nm_per_rad = 40, .at_s = 10, .length_s = 4}.stiffness_at(time_s, 10);
  };
  EXPECT_EQ(at(ArmCourse::kConstant, 30), 10);
  EXPECT_EQ(at(ArmCourse::kStep, 10), 10);
  EXPECT_EQ(at(ArmCourse::kStep, 10.01), 40);
  EXPECT_EQ(at(ArmCourse::kRamp, 9), 10);
  EXPECT_DOUBLE_EQ(at(ArmCourse::kRamp, 11), 17.5);
  EXPECT_EQ(at(ArmCourse::kRamp, 20), 40);
  EXPECT_DOUBLE_EQ(at(ArmCourse::kThereAndBack, 14), 40);
  EXPECT_DOUBLE_EQ(at(ArmCourse::kThereAndBack, 17), 17.5);
  EXPECT_EQ(at(ArmCourse::kThereAndBack, 18.5), 10);
  EXPECT_NEAR(at(ArmCourse::kSwing, 11), 20, 1e-9);  // the geometric mean
  EXPECT_NEAR(at(ArmCourse::kSwing, 12), 40, 1e-9);
  EXPECT_NEAR(at(ArmCourse::kSwing, 14), 10, 1e-9);
}

TEST(DriveTask, TheDampingFollowsTheRootOfTheStiffness) {
  DriveSettings drive = settings();
  drive.change = {.course = ArmCourse::kStep, .stiffness_nm_per_rad = 80, .at_s = 1, .length_s = 1};
  const Column column;
  DriveTask task(drive, column);
  DriveTick tick;
  for (int i = 0; i < 200; ++i) tick = task.next();
  EXPECT_DOUBLE_EQ(tick.truth.arm.stiffness_nm_per_rad, 80);
  EXPECT_DOUBLE_EQ(tick.truth.arm.inertia_kgm2, 0.1);
  const double wheel = column.wheel_damping_nms_per_rad;
  EXPECT_DOUBLE_EQ(tick.truth.arm.damping_nms_per_rad, wheel + 2 * (1.45 - wheel));
}

TEST(DriveTask, HandsThatLeaveTakeArmAndTorqueWithThem) {
  DriveSettings drive = settings();
  drive.releases = {{.at_s = 2, .length_s = 1}, {.at_s = 5, .length_s = 0.5}};
  const Column column;
  DriveTask task(drive, column);
  for (int i = 0; i < 800; ++i) {
    const double t = i * kTickS;
    const DriveTruth truth = task.next().truth;
    const bool off = (t > 2.16 && t < 2.99) || (t > 5.16 && t < 5.49);
    const bool on = t < 1.99 || (t > 3.31 && t < 4.99) || t > 5.81;
    if (off) {
      EXPECT_DOUBLE_EQ(truth.arm.inertia_kgm2, column.wheel_inertia_kgm2) << t;
      EXPECT_DOUBLE_EQ(truth.arm.damping_nms_per_rad, column.wheel_damping_nms_per_rad) << t;
      EXPECT_EQ(truth.arm.stiffness_nm_per_rad, 0) << t;
      EXPECT_EQ(truth.torque_driver_nm, 0) << t;
    }
    if (on) {
      EXPECT_DOUBLE_EQ(truth.arm.stiffness_nm_per_rad, 20) << t;
    }
  }
}

TEST(DriveTask, AnArmLighterThanItsWheelIsRefused) {
  DriveSettings drive = settings();
  drive.arm.inertia_kgm2 = 0.03;
  EXPECT_THROW(DriveTask(drive, Column{}), BadInput);
  drive.arm.inertia_kgm2 = 0.1;
  drive.arm.damping_nms_per_rad = 0.01;
  EXPECT_THROW(DriveTask(drive, Column{}), BadInput);
}

}  // namespace
}  // namespace steerid
