// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Messages that a logger shows a row late, drawn from a motion in closed form, and channels that only repeat.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "log/late_messages.hpp"
#include "log/resample.hpp"
#include "log_motion.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using test::motion_rad;

constexpr double kPeriod_s = 0.01;
constexpr std::size_t kRows = 4000;
constexpr double kNoise_rad = 2e-4;

/// A sensor that sends every `period_s`, and a logger that shows what came last.
struct Logged {
  std::vector<double> values{};
  std::vector<long> message{};  ///< that each row shows
};

Logged logged(std::mt19937_64& bits, double period_s, double phase_s, double most_late_s,
              double noise_rad = kNoise_rad) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> late(0, most_late_s);
  Logged out;
  long last = -1;
  double value = 0;
  double comes_s = 0;
  for (std::size_t i = 0; i < kRows; ++i) {
    while (comes_s <= kPeriod_s * static_cast<double>(i)) {
      const double sent_s = period_s * static_cast<double>(++last);
      value = motion_rad(sent_s) + noise_rad * normal(bits);
      comes_s = period_s * static_cast<double>(last + 1) + phase_s + (most_late_s > 0 ? late(bits) : 0.0);
    }
    out.values.push_back(value);
    out.message.push_back(last);
  }
  return out;
}

/// Rms of what the motion is off where the numbers have it, in rad.
double off_rad(const Logged& drive, const MessageNumbers& found) {
  std::vector<long> offset;
  for (std::size_t m = 0; m < found.row.size(); ++m) offset.push_back(drive.message[found.row[m]] - found.number[m]);
  std::vector<long> sorted = offset;
  std::ranges::nth_element(sorted, sorted.begin() + std::ssize(sorted) / 2);
  const long most = sorted[sorted.size() / 2];
  double squares = 0;
  for (std::size_t m = 0; m < found.row.size(); ++m) {
    const auto is = static_cast<double>(drive.message[found.row[m]]);
    const auto taken = static_cast<double>(found.number[m] + most);
    squares += std::pow(motion_rad(kPeriod_s * is) - motion_rad(kPeriod_s * taken), 2);
  }
  return std::sqrt(squares / static_cast<double>(found.row.size()));
}

TEST(LateMessages, AreNumberedToNearTheNoise) {
  std::mt19937_64 bits(test::seed(71));
  for (const auto& [phase_s, most_late_s, share] : {std::array{0.007, 0.005, 0.4}, std::array{0.0095, 0.001, 0.5}}) {
    const Logged drive = logged(bits, kPeriod_s, phase_s, most_late_s);
    const auto found = message_numbers(drive.values);
    ASSERT_TRUE(found) << phase_s;
    EXPECT_NEAR(found->late_share, share, 0.12);
    EXPECT_LT(off_rad(drive, *found), 3 * kNoise_rad);
    // Every row as if its message was in time: many times the noise.
    MessageNumbers in_time{.row = found->row};
    in_time.number.assign(found->row.begin(), found->row.end());
    EXPECT_GT(off_rad(drive, in_time), 10 * kNoise_rad);
  }
}

TEST(LateMessages, AreNotLostSamples) {
  std::mt19937_64 bits(test::seed(72));
  std::uniform_real_distribution<double> uniform;
  for (const double share : {0.02, 0.1, 0.3}) {
    Logged drive = logged(bits, kPeriod_s, 0.004, 0);
    for (std::size_t i = 1; i < kRows; ++i) {
      if (uniform(bits) < share) drive.values[i] = drive.values[i - 1];
    }
    EXPECT_FALSE(message_numbers(drive.values)) << share;
  }
}

TEST(LateMessages, AreNoneWhereAChannelRepeatsByItself) {
  std::mt19937_64 bits(test::seed(73));
  EXPECT_FALSE(message_numbers(logged(bits, kPeriod_s, 0.004, 0).values));  // all in time
  EXPECT_FALSE(message_numbers(logged(bits, 0.02, 0.003, 0).values));       // a slower sensor
  EXPECT_FALSE(message_numbers(logged(bits, 0.012, 0.003, 0).values));
  EXPECT_FALSE(message_numbers(std::vector<double>(kRows, 0.25)));
  const auto rounded = [&](double step_rad, double noise_rad) {
    std::vector<double> values = logged(bits, kPeriod_s, 0.004, 0, noise_rad).values;
    for (double& value : values) value = step_rad * std::round(value / step_rad);
    return values;
  };
  for (const double step_rad : {1e-5, 1e-4, 5e-4, 2e-3}) EXPECT_FALSE(message_numbers(rounded(step_rad, kNoise_rad)));
  std::normal_distribution<double> normal;
  std::vector<double> rests;
  for (std::size_t i = 0; i < kRows; ++i) rests.push_back(1e-5 * std::round(kNoise_rad * normal(bits) / 1e-5));
  EXPECT_FALSE(message_numbers(rests));
}

TEST(LateMessages, AreInTheirOwnRowsOfAResampledRecord) {
  std::mt19937_64 bits(test::seed(74));
  const Logged drive = logged(bits, kPeriod_s, 0.007, 0.005);
  Record record;
  for (std::size_t i = 0; i < kRows; ++i) {
    record.time_s.push_back(kPeriod_s * static_cast<double>(i));
    record.torque_driver_nm.push_back(std::sin(0.03 * static_cast<double>(i)));
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(drive.values[i]);
  }
  const Resampled resampled = resample_100hz(record);
  EXPECT_FALSE(resampled.untouched);
  EXPECT_NEAR(resampled.late_share[2], 0.4, 0.05);
  ASSERT_EQ(resampled.notes().size(), 1U);
  EXPECT_NE(resampled.notes().front().find("% of the rows of angle show an older message"), std::string::npos);
  ASSERT_GT(resampled.record.size(), kRows - 5);
  double squares = 0;
  double as_logged = 0;
  for (std::size_t i = 0; i < resampled.record.size(); ++i) {
    const double t = resampled.record.time_s[i];
    const auto row = static_cast<std::size_t>(std::lround(t / kPeriod_s));
    ASSERT_EQ(resampled.record.torque_driver_nm[i], record.torque_driver_nm[row]);
    squares += std::pow(resampled.record.angle_rad[i] - motion_rad(t - kPeriod_s), 2);
    as_logged += std::pow(drive.values[row] - motion_rad(t - kPeriod_s), 2);
  }
  EXPECT_LT(squares, 2.5 * kNoise_rad * kNoise_rad * kRows);
  EXPECT_GT(as_logged, 50 * squares);
  EXPECT_TRUE(resample_100hz(resampled.record).notes().empty());
}

}  // namespace
}  // namespace steerid
