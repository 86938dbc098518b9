// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A sensor whose clock is not the logger's, drawn from a motion in closed form, and channels without slips.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "log/angle_clock.hpp"
#include "log/resample.hpp"
#include "log/slipped_messages.hpp"
#include "log_motion.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

constexpr double kRow_s = 0.01;
constexpr std::size_t kRows = 9000;
constexpr double kNoise_rad = 2e-4;

/// The time in rows at which the wheel is fast: a slip while it stands cannot be told.
double fast_row(std::mt19937_64& bits) {
  std::uniform_real_distribution<double> where(0.2 * kRows, 0.8 * kRows);
  for (;;) {
    const double row = std::floor(where(bits));
    const double t = row * kRow_s;
    if (std::abs(motion_rad(t + kRow_s) - motion_rad(t - kRow_s)) > 120 * kNoise_rad) return row;
  }
}

struct Logged {
  std::vector<double> values{};
  std::vector<double> message_s{};  ///< when the message in each row came
};

/// Message m comes at (slip + m (1 + later)) rows, so that one comes just there; counted in rows it comes sooner.
Logged logged(double slip_row, double later, std::mt19937_64& bits) {
  std::normal_distribution<double> normal;
  Logged out;
  double last = -1e9;
  for (std::size_t i = 0; i < kRows; ++i) {
    const double m = std::floor((static_cast<double>(i) - slip_row) / (1 + later));
    const double message_s = kRow_s * (slip_row + m * (1 + later));
    out.values.push_back(m == last ? out.values.back() : motion_rad(message_s) + kNoise_rad * normal(bits));
    out.message_s.push_back(message_s);
    last = m;
  }
  return out;
}

class SlippedMessages : public testing::TestWithParam<double> {};

TEST_P(SlippedMessages, AreCountedThroughAndInStepAtTheSlip) {
  const double later = GetParam();
  std::mt19937_64 bits(seed(811));
  int missed = 0;
  for (int i = 0; i < 20; ++i) {
    const double slip_row = fast_row(bits);
    const Logged drive = logged(slip_row, later, bits);
    const auto found = slipped_numbers(drive.values, true);
    if (!found) {
      ++missed;
      continue;
    }
    ASSERT_EQ(found->slips.size(), 1U);
    EXPECT_NEAR(static_cast<double>(found->slips.front()), slip_row, 2);
    for (std::size_t m = 0; m < found->row.size(); ++m) {
      // Where no message is older than the drift makes it: within a row of its number everywhere, and there at the
      // slip.
      const double number = static_cast<double>(found->number[m]);
      const double came = drive.message_s[found->row[m]] / kRow_s;
      ASSERT_NEAR(number - came, -later * (number - slip_row), 0.01) << found->row[m];
    }
  }
  EXPECT_LE(missed, later > 0 ? 0 : 1);
}

INSTANTIATE_TEST_SUITE_P(Clocks, SlippedMessages, testing::Values(1e-4, -1e-4, 4e-5, -4e-5));

TEST(SlippedMessage, OfAnAngleIsReadByTheTorquesClock) {
  std::mt19937_64 bits(seed(812));
  for (const double later : {1e-4, -1e-4}) {
    const Logged drive = logged(fast_row(bits), later, bits);
    Record record;
    for (std::size_t i = 0; i < kRows; ++i) record.time_s.push_back(kRow_s * static_cast<double>(i));
    for (const double t : record.time_s) record.torque_driver_nm.push_back(std::sin(3 * t));
    record.torque_motor_nm.assign(kRows, 0.0);
    record.angle_rad = drive.values;
    const Resampled resampled = resample_100hz(record);
    ASSERT_TRUE(resampled.in_step_s());
    ASSERT_EQ(resampled.notes().size(), 1U);
    EXPECT_THAT(resampled.notes().front(), testing::HasSubstr("angle repeats or skips a message at"));
    const Record read = by_one_clock(resampled.record, {.later_per_s = -later}, resampled.in_step_s());
    double squares = 0;
    double as_logged = 0;
    for (std::size_t i = 0; i < read.size(); ++i) {
      squares += std::pow(read.angle_rad[i] - motion_rad(read.time_s[i]), 2);
      as_logged += std::pow(
          drive.values[static_cast<std::size_t>(std::lround(read.time_s[i] / kRow_s))] - motion_rad(read.time_s[i]), 2);
    }
    EXPECT_LT(squares / static_cast<double>(read.size()), 1.5 * kNoise_rad * kNoise_rad) << later;
    EXPECT_GT(as_logged, 20 * squares);
  }
}

TEST(SlippedMessage, IsNotTakenFromASampleThatWasLost) {
  std::mt19937_64 bits(seed(813));
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> values;
    for (std::size_t row = 0; row < kRows; ++row) {
      values.push_back(motion_rad(kRow_s * static_cast<double>(row)) + kNoise_rad * normal(bits));
    }
    const auto row = static_cast<std::size_t>(fast_row(bits));
    for (const std::size_t lost : {row, row + 40, row + 75}) values[lost] = values[lost - 1];
    EXPECT_FALSE(slipped_numbers(values, true));
  }
}

TEST(SlippedMessage, IsNotTakenFromAMotionWithoutOne) {
  std::mt19937_64 bits(seed(814));
  std::normal_distribution<double> normal;
  for (const double impact_hz : {0.0, 0.5}) {  // a wheel that runs against a stop has other rates before and behind
    int taken = 0;
    for (int i = 0; i < 20; ++i) {
      std::vector<double> values;
      const double at_s = 40 * std::abs(normal(bits));
      for (std::size_t row = 0; row < kRows; ++row) {
        const double t = kRow_s * static_cast<double>(row);
        const double bounce = impact_hz > 0 ? 0.2 * std::abs(std::sin(std::numbers::pi * impact_hz * (t - at_s))) : 0;
        values.push_back(motion_rad(t) + bounce + kNoise_rad * normal(bits));
      }
      taken += slipped_numbers(values, true) ? 1 : 0;
    }
    EXPECT_EQ(taken, 0) << impact_hz;  // 900 impacts by 0.6 rad/s
  }
}

TEST(SlippedMessage, IsNotTakenFromTwoMessagesThatReadAlike) {
  std::mt19937_64 bits(seed(816));
  std::normal_distribution<double> normal;
  constexpr double kStep_rad = kNoise_rad / 250;  // some three of 9,000 pairs read alike by chance
  int alike = 0;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> values;
    for (std::size_t row = 0; row < kRows; ++row) {
      const double t = kRow_s * static_cast<double>(row);
      values.push_back(kStep_rad * std::round((motion_rad(0.1 * t) + kNoise_rad * normal(bits)) / kStep_rad));
      alike += row > 0 && values[row] == values[row - 1] ? 1 : 0;
    }
    EXPECT_FALSE(slipped_numbers(values, true));
    EXPECT_FALSE(slipped_numbers(values, false));
  }
  EXPECT_GT(alike, 20);
}

TEST(SlippedMessage, OfATorqueShowsByARepeatAlone) {
  std::mt19937_64 bits(seed(815));
  for (const double later : {1e-4, -1e-4}) {
    const auto found = slipped_numbers(logged(fast_row(bits), later, bits).values, false);
    EXPECT_EQ(found.has_value(), later > 0);
  }
}

}  // namespace
}  // namespace steerid::test
