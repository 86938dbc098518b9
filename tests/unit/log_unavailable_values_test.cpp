// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Numbers that stand for no measurement, among drawn readings, and numbers that are far from the rest and are readings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "log/log_reader.hpp"
#include "log/unavailable_values.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

/// Readings of 8 Nm, or of 8 rad, in all, to a thousandth.
std::vector<double> readings(std::uint64_t fallback) {
  std::mt19937_64 bits(seed(fallback));
  std::uniform_real_distribution<double> value(-4, 4);
  std::vector<double> out;
  for (int i = 0; i < 5000; ++i) out.push_back(std::round(1000 * value(bits)) / 1000);
  return out;
}

std::vector<double> with(std::vector<double> values, double number, std::size_t from, std::size_t rows) {
  std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(from), rows, number);
  return values;
}

TEST(UnavailableValues, AreTheLargestThatABusCanSendAndWhatLoggersWrite) {
  const std::vector<double> read = readings(821);
  for (const double number : {655.35, -9999.0, 1e30, 32767.0}) {
    for (const std::size_t rows : {2, 300, 1400}) {
      std::vector<double> values = with(read, number, 700, rows);
      const UnavailableValues found = leave_out_unavailable(values, Channel::kTorqueDriver);
      EXPECT_THAT(found.value, testing::ElementsAre(number));
      EXPECT_EQ(found.rows, rows);
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(std::isnan(values[i]), i >= 700 && i < 700 + rows);
        if (std::isnan(values[i])) continue;
        ASSERT_EQ(values[i], read[i]);
      }
    }
  }
}

TEST(UnavailableValues, MayBeSeveral) {
  std::vector<double> values = with(with(with(readings(822), 655.34, 10, 5), 655.35, 900, 40), -9999, 3000, 3);
  const UnavailableValues found = leave_out_unavailable(values, Channel::kTorqueBar);
  EXPECT_THAT(found.value, testing::ElementsAre(-9999, 655.34, 655.35));
  EXPECT_EQ(found.rows, 48U);
}

TEST(UnavailableValues, OfAnAngleNeedNotBeAsFar) {
  // 3276.7 deg of a wheel that turns by 8 rad.
  const std::vector<double> read = with(readings(823), 57.19, 700, 30);
  std::vector<double> values = read;
  EXPECT_EQ(leave_out_unavailable(values, Channel::kAngle).rows, 30U);
  values = read;
  EXPECT_EQ(leave_out_unavailable(values, Channel::kTorqueDriver).rows, 0U);
  EXPECT_EQ(values, read);
}

TEST(UnavailableValues, AreNoReadings) {
  const auto expect_none = [](std::vector<double> values, const std::string& what) {
    const std::vector<double> before = values;
    EXPECT_EQ(leave_out_unavailable(values, Channel::kTorqueMotor).rows, 0U) << what;
    EXPECT_EQ(values, before) << what;
  };
  expect_none(readings(824), "nothing far");
  expect_none(with(readings(824), 50, 100, 400), "a torque that is six times the others'");
  expect_none(with(readings(824), 900, 100, 1), "a spike");
  std::vector<double> command(5000, 0.0);
  for (std::size_t i = 1000; i < 1500; ++i) command[i] = 2;
  expect_none(command, "a step");
  for (std::size_t i = 0; i < command.size(); ++i) command[i] = i % 700 < 350 ? 1 : i % 1400 < 700 ? 1.01 : 30;
  expect_none(command, "three levels");
  expect_none({}, "no rows");
  expect_none({1, 1, 1e9, 1e9}, "four rows");
}

TEST(UnavailableValues, AreLeftOutOfALogAsRowsWithoutAValue) {
  std::ostringstream text;
  text << "time_s,torque_driver_nm,angle_deg\n";
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.01 * i;
    text << t << ',' << (i >= 1000 && i < 1050 ? 655.35 : std::sin(5 * t) + std::cos(3.1 * t)) << ','
         << (i >= 2000 && i < 2020 ? 3276.7 : 20 * std::cos(3 * t)) << '\n';
  }
  std::istringstream in(text.str());
  RecordQuality seen;
  const Record record = read_log(in, "drive.csv", {}, &seen);
  EXPECT_EQ(record.size(), 2930U);
  EXPECT_EQ(seen.gaps.size(), 2U);
  EXPECT_THAT(seen.notes, testing::Contains(testing::HasSubstr("torque_driver reads 655.35 in 50 rows")));
  EXPECT_THAT(seen.notes, testing::Contains(testing::HasSubstr("angle reads 57.1")));
}

}  // namespace
}  // namespace steerid::test
