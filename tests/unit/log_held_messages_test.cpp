// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Loggers that hold each channel's last message, drawn from motions in closed form, and channels that stand still for
// other reasons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "log/bad_input.hpp"
#include "log/resample.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

constexpr double kLength_s = 40;
constexpr double kTorqueNoise_nm = 4e-3;
constexpr double kAngleNoise_rad = 1e-4;

double sines(double t, double phase) {
  double sum = 0;
  for (const double hz : {0.4, 1.1, 2.3, 3.7, 5.2})
    sum += 0.1 / hz * std::cos(2 * std::numbers::pi * hz * t + phase * hz);
  return sum;
}
double torque_nm(double t) { return 4 * sines(t, 1); }
double angle_rad(double t) { return sines(t, 3); }

std::vector<double> even(double period_s) {
  std::vector<double> time_s;
  for (double i = 1; i * period_s < kLength_s; ++i) time_s.push_back(i * period_s);
  return time_s;
}

std::vector<double> read_at(const std::vector<double>& time_s, double (*value)(double)) {
  std::vector<double> values;
  for (const double t : time_s) values.push_back(value(t));
  return values;
}

struct Sender {
  double period_s;
  double phase_s = 0;
  double most_late_s = 0;  ///< that the bus makes a message wait
};

/// What rows at `time_s` show of a sensor that reads `value` with white noise.
std::vector<double> held(const std::vector<double>& time_s, Sender sender, const std::function<double(double)>& value,
                         double noise, std::mt19937_64& bits) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> late(0, 1);
  std::vector<double> shown;
  double last = value(0);
  double message = 1;
  double comes_s = sender.period_s + sender.phase_s;
  for (const double t : time_s) {
    while (comes_s <= t + 1e-9) {
      last = value(message * sender.period_s + sender.phase_s) + noise * normal(bits);
      ++message;
      comes_s = message * sender.period_s + sender.phase_s + sender.most_late_s * late(bits);
    }
    shown.push_back(last);
  }
  return shown;
}

Record record_of(std::vector<double> time_s, std::vector<double> torque, std::vector<double> angle) {
  Record record;
  record.torque_motor_nm.assign(time_s.size(), 0.0);
  record.time_s = std::move(time_s);
  record.torque_driver_nm = std::move(torque);
  record.angle_rad = std::move(angle);
  return record;
}

/// Rms of what is off the motion, at `late_s` behind the stamps.
double off(const std::vector<double>& time_s, const std::vector<double>& values, double (*value)(double),
           double late_s = 0) {
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) squares += std::pow(values[i] - value(time_s[i] - late_s), 2);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

struct Case {
  std::string name;
  double row_s;
  Sender torque;
  Sender angle;
  double told_to_s;  ///< how far the time of a message may be off
};

class HeldMessagesOf : public testing::TestWithParam<Case> {};

TEST_P(HeldMessagesOf, AreReadWhenTheyCame) {
  const Case& one = GetParam();
  std::mt19937_64 bits(seed(801));
  const std::vector<double> rows_s = even(one.row_s);
  const Record record = record_of(rows_s, held(rows_s, one.torque, torque_nm, kTorqueNoise_nm, bits),
                                  held(rows_s, one.angle, angle_rad, kAngleNoise_rad, bits));
  const Resampled resampled = resample_100hz(record);
  EXPECT_NEAR(resampled.message_hz[0] * one.torque.period_s, 1, 1e-4);
  EXPECT_NEAR(resampled.message_hz[2] * one.angle.period_s, 1, 1e-4);
  ASSERT_GT(static_cast<double>(resampled.record.size()), 100 * kLength_s - 80);
  const std::vector<double>& time_s = resampled.record.time_s;
  // A time that is off by told_to_s moves torque and angle by their rates.
  EXPECT_LT(off(time_s, resampled.record.torque_driver_nm, torque_nm), 1.2 * kTorqueNoise_nm + 4 * one.told_to_s);
  EXPECT_LT(off(time_s, resampled.record.angle_rad, angle_rad), 1.2 * kAngleNoise_rad + one.told_to_s);
  EXPECT_GT(off(rows_s, record.angle_rad, angle_rad), 4 * (kAngleNoise_rad + one.told_to_s));
}

INSTANTIATE_TEST_SUITE_P(
    Loggers, HeldMessagesOf,
    testing::Values(Case{"OneMillisecondAndTwoClocks", 1e-3, {0.0100002, 0.0034}, {0.0099997, 0.0071}, 2e-4},
                    Case{"OneMillisecondAndABus", 1e-3, {0.0100002, 0.0034, 2e-3}, {0.0099997, 0.0071, 2e-3}, 4e-4},
                    Case{"OneMillisecondAndTwoRates", 1e-3, {0.01, 0.004}, {0.02, 0.008}, 0},
                    Case{"FiveMillisecondsAndSeven", 5e-3, {0.007, 0.001}, {0.013, 0.002}, 1e-3},
                    Case{"TwoMillisecondsAndThree", 2e-3, {0.003, 0}, {0.01, 0}, 1e-3}),
    [](const auto& tested) { return tested.param.name; });

TEST(HeldMessages, OfOneClockAreTheRecord) {
  std::mt19937_64 bits(seed(802));
  const std::vector<double> rows_s = even(1e-3);
  const Sender sender{0.01, 0.004};
  const Record record = record_of(rows_s, held(rows_s, sender, torque_nm, kTorqueNoise_nm, bits),
                                  held(rows_s, sender, angle_rad, kAngleNoise_rad, bits));
  const Resampled resampled = resample_100hz(record);
  EXPECT_FALSE(resampled.filtered);
  ASSERT_GT(resampled.record.size(), 3990U);
  for (std::size_t i = 0; i < resampled.record.size(); ++i) {
    const auto row = static_cast<std::size_t>(std::lround(resampled.record.time_s[i] * 1000)) - 1;
    ASSERT_EQ(resampled.record.angle_rad[i], record.angle_rad[row]);
    ASSERT_EQ(resampled.record.torque_driver_nm[i], record.torque_driver_nm[row]);
    if (row == 0) continue;
    ASSERT_NE(record.angle_rad[row], record.angle_rad[row - 1]);
  }
  ASSERT_EQ(resampled.notes().size(), 1U);
  EXPECT_THAT(resampled.notes().front(), testing::HasSubstr("angle comes 100 times a second"));
}

TEST(HeldMessages, OfASensorThatIsSlowerThanTheRowsByAFifth) {
  std::mt19937_64 bits(seed(803));
  const std::vector<double> rows_s = even(0.01);
  const std::vector<double> torque = read_at(rows_s, torque_nm);
  const Record record = record_of(rows_s, torque, held(rows_s, {0.012}, angle_rad, kAngleNoise_rad, bits));
  const Resampled resampled = resample_100hz(record);
  EXPECT_NEAR(resampled.message_hz[2], 1 / 0.012, 1e-3);
  EXPECT_EQ(resampled.message_hz[0], 0);
  EXPECT_LT(off(resampled.record.time_s, resampled.record.angle_rad, angle_rad), 1.2 * kAngleNoise_rad);
  EXPECT_LT(off(resampled.record.time_s, resampled.record.torque_driver_nm, torque_nm), 1e-4);
  EXPECT_GT(off(rows_s, record.angle_rad, angle_rad), 20 * kAngleNoise_rad);
}

TEST(HeldMessages, MayBeLostOrReadAlike) {
  std::mt19937_64 bits(seed(809));
  std::uniform_real_distribution<double> share(0, 1);
  const std::vector<double> rows_s = even(0.01);
  const std::vector<double> torque = read_at(rows_s, torque_nm);
  for (const double period_s : {0.011, 0.012, 0.014, 0.02}) {
    std::vector<double> angle = held(rows_s, {period_s}, angle_rad, kAngleNoise_rad, bits);
    for (std::size_t i = 1; i < angle.size(); ++i) {
      if (angle[i] != angle[i - 1] && share(bits) < 0.005) angle[i] = angle[i - 1];
    }
    const Resampled resampled = resample_100hz(record_of(rows_s, torque, angle));
    EXPECT_NEAR(resampled.message_hz[2] * period_s, 1, 1e-4) << period_s;
    EXPECT_LT(off(resampled.record.time_s, resampled.record.angle_rad, angle_rad), 0.2 * off(rows_s, angle, angle_rad))
        << period_s;
  }
}

TEST(HeldMessages, SurviveAGap) {
  std::mt19937_64 bits(seed(804));
  std::vector<double> rows_s = even(1e-3);
  std::vector<double> torque = held(rows_s, {0.01, 0.004}, torque_nm, kTorqueNoise_nm, bits);
  std::vector<double> angle = held(rows_s, {0.02, 0.008}, angle_rad, kAngleNoise_rad, bits);
  for (std::vector<double>* const column : {&rows_s, &torque, &angle}) {
    column->erase(column->begin() + 15'003, column->begin() + 17'777);
  }
  const Resampled resampled = resample_100hz(record_of(rows_s, torque, angle));
  EXPECT_EQ(resampled.dropped_stretches, 0U);
  ASSERT_GT(resampled.record.size(), 3500U);
  EXPECT_LT(off(resampled.record.time_s, resampled.record.angle_rad, angle_rad), 1.2 * kAngleNoise_rad);
  EXPECT_LT(off(resampled.record.time_s, resampled.record.torque_driver_nm, torque_nm), 1.2 * kTorqueNoise_nm);
}

TEST(HeldMessages, OfASlowSensorAreRefused) {
  std::mt19937_64 bits(seed(805));
  const std::vector<double> rows_s = even(0.01);
  const std::vector<double> torque = read_at(rows_s, torque_nm);
  const Record record = record_of(rows_s, torque, held(rows_s, {0.04}, angle_rad, kAngleNoise_rad, bits));
  try {
    (void)resample_100hz(record, "slow.csv");
    FAIL();
  } catch (const BadInput& complaint) {
    EXPECT_THAT(complaint.what(),
                testing::AllOf(testing::HasSubstr("slow.csv"), testing::HasSubstr("angle"), testing::HasSubstr("25")));
  }
}

/// What stands still for another reason is left as it is.
void expect_untouched(const Record& record, const std::string& what) {
  const Resampled resampled = resample_100hz(record);
  for (const double hz : resampled.message_hz) EXPECT_EQ(hz, 0) << what;
}

TEST(HeldMessages, AreNoStairsOfATorqueBesideAnAngleOfEveryRow) {
  std::mt19937_64 bits(seed(806));
  const std::vector<double> rows_s = even(1e-3);
  const std::vector<double> angle = read_at(rows_s, angle_rad);
  std::uniform_real_distribution<double> level(-1, 1);
  expect_untouched(record_of(rows_s, held(rows_s, {0.01}, torque_nm, 0, bits), angle), "a smooth command");
  expect_untouched(record_of(rows_s,
                             held(
                                 rows_s, {0.01}, [&](double) { return level(bits); }, 0, bits),
                             angle),
                   "drawn levels");
  expect_untouched(record_of(rows_s,
                             held(
                                 rows_s, {0.01}, [&](double) { return std::copysign(1.0, level(bits)); }, 0, bits),
                             angle),
                   "a binary sequence");
}

TEST(HeldMessages, AreNoCoarseAngle) {
  const std::vector<double> rows_s = even(1e-3);
  const std::vector<double> torque = read_at(rows_s, torque_nm);
  std::mt19937_64 bits(seed(807));
  for (const double noise : {0.0, 2e-4}) {
    for (const double step : {5e-4, 2e-3, 1e-2}) {
      std::normal_distribution<double> normal;
      std::vector<double> angle;
      for (const double t : rows_s) angle.push_back(step * std::round((angle_rad(t) + noise * normal(bits)) / step));
      expect_untouched(record_of(rows_s, torque, angle), "steps of " + std::to_string(step));
    }
  }
}

TEST(HeldMessages, AreNoConstantRate) {
  const std::vector<double> rows_s = even(1e-3);
  std::vector<double> torque;
  std::vector<double> angle;
  for (const double t : rows_s) {
    torque.push_back(torque_nm(t));
    const double turn = std::abs(std::remainder(0.1 * t, 1.0));  // a triangle of 0.1 Hz
    angle.push_back(1e-3 * std::round(turn / 1e-3));
  }
  expect_untouched(record_of(rows_s, torque, angle), "a triangle");
}

/// Rows of which one in a hundred is missing, and others repeat a rounded angle by chance: as many changes as messages
/// that come every 10.3 ms would make.
TEST(HeldMessages, AreNoRowsOfWhichSomeAreMissing) {
  constexpr int kDraws = 20;
  constexpr double kStep_rad = 5e-4;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::mt19937_64 bits(seed(809) + static_cast<std::uint64_t>(draw));
    std::uniform_real_distribution<double> share(0, 1);
    std::normal_distribution<double> normal;
    std::vector<double> rows_s;
    std::vector<double> torque;
    std::vector<double> angle;
    for (const double t : even(0.01)) {
      if (share(bits) < 0.01) continue;
      rows_s.push_back(t);
      torque.push_back(torque_nm(t) + kTorqueNoise_nm * normal(bits));
      angle.push_back(kStep_rad * std::round((angle_rad(t) + 4 * kAngleNoise_rad * normal(bits)) / kStep_rad));
    }
    const Resampled resampled = resample_100hz(record_of(rows_s, torque, angle));
    EXPECT_EQ(resampled.message_hz[2], 0) << "draw " << draw;
    EXPECT_GT(static_cast<double>(resampled.record.size()), 98 * kLength_s);
  }
}

TEST(HeldMessages, AreNoLostSamples) {
  std::mt19937_64 bits(seed(808));
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  const std::vector<double> rows_s = even(0.01);
  for (const double lost : {0.02, 0.1, 0.4}) {
    std::vector<double> torque;
    std::vector<double> angle;
    for (const double t : rows_s) {
      torque.push_back(torque_nm(t) + kTorqueNoise_nm * normal(bits));
      angle.push_back(!angle.empty() && share(bits) < lost ? angle.back()
                                                           : angle_rad(t) + kAngleNoise_rad * normal(bits));
    }
    expect_untouched(record_of(rows_s, torque, angle), std::to_string(lost) + " lost");
  }
}

}  // namespace
}  // namespace steerid::test
