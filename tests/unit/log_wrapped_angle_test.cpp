// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Angles that begin anew after every turn, and angles that jump for other reasons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <sstream>
#include <vector>

#include "log/log_reader.hpp"
#include "log/wrapped_angle.hpp"

namespace steerid::test {
namespace {

using std::numbers::pi;

/// 40 s at 100 Hz, two turns to either side around `middle_rad`.
std::vector<double> turning(double middle_rad, double amplitude_rad) {
  std::vector<double> angle;
  for (int i = 0; i < 4000; ++i) angle.push_back(middle_rad + amplitude_rad * std::sin(0.02 * i));
  return angle;
}

double wrapped(double angle, double from) { return angle - 2 * pi * std::floor((angle - from) / (2 * pi)); }

TEST(WrappedAngle, HasItsTurnsCountedThrough) {
  for (const double amplitude : {0.3, 4 * pi}) {
    for (const double from : {0.0, -pi}) {
      const std::vector<double> angle = turning(from, amplitude);
      std::vector<double> values;
      for (const double one : angle) values.push_back(wrapped(one, from));
      EXPECT_GT(count_turns(values), 20U);
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_NEAR(values[i] - angle[i], std::round((values[0] - angle[0]) / (2 * pi)) * 2 * pi, 1e-9) << i;
        ASSERT_LT(std::abs(values[i]), amplitude + pi + 0.1);
      }
    }
  }
}

TEST(WrappedAngle, MayLackValues) {
  std::vector<double> values;
  for (const double one : turning(0, 0.3)) values.push_back(wrapped(one, 0));
  const std::size_t jumps = count_turns(values);
  for (std::size_t i = 0; i < values.size(); i += 3) values[i] = std::numeric_limits<double>::quiet_NaN();
  for (double& one : values) one = wrapped(one, 0);
  EXPECT_EQ(count_turns(values), jumps);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_NEAR(std::abs(values[2] - values[1]), 0, 0.1);
}

TEST(WrappedAngle, IsNoOther) {
  const auto expect_left = [](std::vector<double> values) {
    const std::vector<double> before = values;
    EXPECT_EQ(count_turns(values), 0U);
    EXPECT_EQ(values, before);
  };
  expect_left({});
  expect_left(turning(0, 0.3));
  expect_left(turning(0, 4 * pi));
  std::vector<double> half = turning(0, 0.3);  // a sensor that is off by half a turn for a while
  for (std::size_t i = 1000; i < 1500; ++i) half[i] += pi;
  expect_left(half);
  std::vector<double> more = turning(0, 0.3);  // and one by three
  for (std::size_t i = 1000; i < 1500; ++i) more[i] += 6 * pi;
  expect_left(more);
}

TEST(WrappedAngle, IsReadAsTheWheelTurns) {
  std::ostringstream text;
  text << "time_s,torque_driver_nm,angle_deg\n";
  const std::vector<double> angle = turning(0, 0.3);
  for (std::size_t i = 0; i < angle.size(); ++i) {
    text << 0.01 * static_cast<double>(i) << ",1," << 180 / pi * wrapped(angle[i], 0) << '\n';
  }
  std::istringstream in(text.str());
  RecordQuality seen;
  const Record record = read_log(in, "drive.csv", {}, &seen);
  ASSERT_EQ(record.size(), angle.size());
  for (std::size_t i = 0; i < angle.size(); ++i) ASSERT_NEAR(record.angle_rad[i], angle[i], 1e-4);
  EXPECT_THAT(seen.notes, testing::Contains(testing::HasSubstr("begins anew after every turn")));
}

}  // namespace
}  // namespace steerid::test
