// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A motion in closed form, rounded, and had back from where it passes from step to step.
#include "gap/preparation/between_steps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace steerid::gap {
namespace {

constexpr double kStep_rad = 0.05;

double motion_rad(double t) { return 0.3 * std::sin(0.9 * t) + 0.05 * std::sin(2.3 * t); }
constexpr double kFastest_rad_s = 0.3 * 0.9 + 0.05 * 2.3;

/// That motion as it is recorded, rounded.
Record rounded() {
  Record record;
  for (int i = 0; i < 4000; ++i) {
    record.time_s.push_back(0.01 * i);
    record.angle_rad.push_back(kStep_rad * std::round(motion_rad(0.01 * i) / kStep_rad));
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(0);
  }
  return record;
}

template <typename Run>
std::vector<double> error_rad(const Run& run) {
  const Record record = rounded();
  std::vector<double> run_rad;
  for (const double t : record.time_s) run_rad.push_back(run(t));
  std::vector<double> error = between_steps(record, run_rad, kStep_rad);
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= motion_rad(record.time_s[i]);
  return error;
}

double largest(const std::vector<double>& x) {
  double most = 0;
  for (const double value : x) most = std::max(most, std::abs(value));
  return most;
}

double rms(const std::vector<double>& x) {
  double sum = 0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

TEST(BetweenSteps, ARightRunIsKeptToWithinHalfASample) {
  // When within a sample the angle passes is not known.
  EXPECT_LE(largest(error_rad([](double t) { return motion_rad(t); })), 0.005 * kFastest_rad_s);
}

TEST(BetweenSteps, WhatChangesSlowlyIsTakenFromThePassages) {
  // A run that is off by up to 0.06 rad, in 20 s: half a sample's motion, and what bends in a second or two at most.
  const std::vector<double> error = error_rad([](double t) { return motion_rad(t) + 0.06 * std::cos(0.3 * t); });
  EXPECT_LT(rms(error), 0.05 * kStep_rad);
  EXPECT_LT(largest(error), kStep_rad);
}

TEST(BetweenSteps, AWrongRunIsBetterThanTheRoundedAngle) {
  const double by_rounding = kStep_rad / std::sqrt(12.0);
  EXPECT_LT(rms(error_rad([](double t) { return 0.7 * motion_rad(t); })), 0.4 * by_rounding);
  EXPECT_GT(rms(error_rad([](double) { return 0.0; })), 0.1 * by_rounding);  // nothing is known of turning back
}

TEST(BetweenSteps, TheRecordedStepIsNeverLeft) {
  const Record record = rounded();
  std::vector<double> run_rad(record.size());
  for (std::size_t i = 0; i < run_rad.size(); ++i) run_rad[i] = 2 * std::sin(7 * record.time_s[i]);
  const std::vector<double> angle = between_steps(record, run_rad, kStep_rad);
  for (std::size_t i = 0; i < angle.size(); ++i) {
    EXPECT_LE(std::abs(angle[i] - record.angle_rad[i]), 0.5001 * kStep_rad);
  }
}

TEST(BetweenSteps, AnAngleThatStaysIsAsRecorded) {
  Record record = rounded();
  record.angle_rad.assign(record.size(), 0.1);
  EXPECT_EQ(between_steps(record, std::vector<double>(record.size(), 0.3), kStep_rad), record.angle_rad);
}

}  // namespace
}  // namespace steerid::gap
