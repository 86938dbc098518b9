// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Spikes planted in records of known samples, and records that have none.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "log/spikes.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

/// Uniform from raw bits, -1 to 1.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : bits_(seed) {}
  double operator()() { return static_cast<double>(bits_() >> 11) * 0x1p-52 - 1.0; }

 private:
  std::mt19937_64 bits_;
};

/// A minute at 100 Hz: 1 and 8 Hz on every channel, with white noise of 1 %.
Record drive(std::uint64_t seed) {
  Uniform noise(seed);
  Record record;
  for (int i = 0; i < 6000; ++i) {
    const double t = 0.01 * i;
    const auto at = [&](double phase) {
      return std::sin(6.28 * t + phase) + 0.1 * std::sin(50.3 * t + phase) + 0.017 * noise();
    };
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(3 * at(0));
    record.torque_motor_nm.push_back(at(1));
    record.angle_rad.push_back(0.3 * at(2));
  }
  return record;
}

TEST(LogSpikes, AreReplacedByWhatTheirNeighboursSay) {
  const Record clean = drive(seed(51));
  Record record = clean;
  const std::vector<std::size_t> torque_at = {2, 700, 705, 4100, 5997};
  const std::vector<std::size_t> angle_at = {31, 700, 2999};
  for (const std::size_t i : torque_at) record.torque_driver_nm[i] += i % 2 == 0 ? 20 : -20;
  for (const std::size_t i : angle_at) record.angle_rad[i] = 6.28;
  const Spikes spikes = mend_spikes(record);
  EXPECT_EQ(spikes.of(Channel::kTorqueDriver), torque_at.size());
  EXPECT_EQ(spikes.of(Channel::kTorqueMotor), 0U);
  EXPECT_EQ(spikes.of(Channel::kAngle), angle_at.size());
  EXPECT_NE(spikes.note().find("5 of torque_driver, 3 of angle"), std::string::npos) << spikes.note();
  // The cubic misses 8 Hz of 100 by its fourth difference, 6 %, and sums the noise of five samples.
  for (std::size_t i = 0; i < clean.size(); ++i) {
    EXPECT_NEAR(record.torque_driver_nm[i], clean.torque_driver_nm[i], 3 * (0.1 * 0.06 + 4 * 0.017));
    EXPECT_NEAR(record.angle_rad[i], clean.angle_rad[i], 0.3 * (0.1 * 0.06 + 4 * 0.017));
  }
  EXPECT_EQ(record.torque_motor_nm, clean.torque_motor_nm);
}

TEST(LogSpikes, EveryChannelThatIsThereIsMended) {
  Record record = drive(seed(51));
  record.channels = kAngleValid | kTorqueBarValid | kProbeValid;
  record.torque_bar_nm = record.torque_driver_nm;
  record.probe_nm = record.torque_motor_nm;
  const std::vector<double> clean = record.torque_bar_nm;
  record.torque_bar_nm[2000] += 30;
  const Spikes spikes = mend_spikes(record);
  EXPECT_EQ(spikes.of(Channel::kTorqueBar), 1U);
  EXPECT_EQ(spikes.all(), 1U);
  EXPECT_NEAR(record.torque_bar_nm[2000], clean[2000], 1);
  EXPECT_NE(spikes.note().find("1 of torque_bar"), std::string::npos) << spikes.note();
}

void expect_untouched(const Record& given) {
  Record record = given;
  EXPECT_EQ(mend_spikes(record).all(), 0U);
  EXPECT_EQ(record.torque_driver_nm, given.torque_driver_nm);
  EXPECT_EQ(record.angle_rad, given.angle_rad);
  EXPECT_TRUE(mend_spikes(record).note().empty());
}

TEST(LogSpikes, WhatIsNoneStays) {
  const Record clean = drive(seed(52));
  expect_untouched(clean);
  // A coarse angle that flickers by a step; torques that were held for some samples; steps of the torque; a plateau.
  Record coarse = clean;
  for (double& angle : coarse.angle_rad) angle = 0.05 * std::round(angle / 0.05);
  expect_untouched(coarse);
  Record held = clean;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (i % 40 < 7) held.angle_rad[i] = held.angle_rad[i - i % 40];
  }
  expect_untouched(held);
  Record steps = clean;
  for (std::size_t i = 0; i < steps.size(); ++i) steps.torque_driver_nm[i] += i / 500 % 2 == 0 ? 15 : -15;
  expect_untouched(steps);
  Record still = clean;
  for (double& torque : still.torque_driver_nm) torque = 0;
  still.torque_driver_nm[300] = 1;  // nothing says what is usual there
  expect_untouched(still);
}

TEST(LogSpikes, ThreeInAThousandAreNoSpikes) {
  Record record = drive(seed(53));
  for (std::size_t i = 100; i < record.size(); i += 250) record.angle_rad[i] += 3;  // 24 of 6000: four
  expect_untouched(record);
  Record fewer = drive(seed(53));
  for (std::size_t i = 100; i < fewer.size(); i += 400) fewer.angle_rad[i] += 3;  // 15: 2.5
  EXPECT_EQ(mend_spikes(fewer).of(Channel::kAngle), 15U);
}

TEST(LogSpikes, NeighboursAcrossAGapSayNothing) {
  Record record = drive(seed(54));
  for (std::size_t i = 3000; i < record.size(); ++i) record.time_s[i] += 5;
  record.torque_motor_nm[2999] += 20;
  record.torque_motor_nm[3001] += 20;
  record.torque_motor_nm[3002] += 20;  // two in a row
  expect_untouched(record);
}

TEST(LogSpikes, AShortRecordHasNone) {
  for (int rows = 0; rows < 6; ++rows) {
    Record record;
    for (int i = 0; i < rows; ++i) {
      record.time_s.push_back(0.01 * i);
      for (auto* channel : {&record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad}) {
        channel->push_back(i == 2 ? 1 : 0);
      }
    }
    expect_untouched(record);
  }
}

}  // namespace
}  // namespace steerid::test
