// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The replayed back end: rows become samples at their ticks, once each.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "backend/replayed.hpp"

namespace steerid {
namespace {

Record rows(const std::vector<double>& time_s) {
  Record record;
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    record.time_s.push_back(time_s[k]);
    record.torque_driver_nm.push_back(0.001 * static_cast<double>(k));
    record.torque_motor_nm.push_back(-2.0);
    record.angle_rad.push_back(1e-6 * static_cast<double>(k));
  }
  return record;
}

TEST(ReplayedHal, HandsOutEveryRowAtItsTick) {
  const Record record = rows({5.0, 5.01, 5.02});
  ReplayedHal hal(record);
  Sample sample;
  for (int k = 0; k < 3; ++k) {
    ASSERT_EQ(hal.wait_tick(), Status::kOk);
    ASSERT_EQ(hal.read_sample(sample), Status::kOk);
    EXPECT_EQ(sample.stamp_us, k * kTickPeriodUs);
    EXPECT_EQ(sample.sequence, k);
    EXPECT_EQ(sample.angle_urad, k);
    EXPECT_EQ(sample.torque_driver_mnm, k);
    EXPECT_EQ(sample.torque_motor_mnm, -2000);
    EXPECT_EQ(sample.valid_bits, kAllChannelsValid);
  }
  EXPECT_EQ(hal.wait_tick(), Status::kEndOfStream);
}

TEST(ReplayedHal, TicksGoOnInAGap) {
  const Record record = rows({0.0, 0.01, 0.05});
  ReplayedHal hal(record);
  Sample sample;
  std::vector<Status> reads;
  while (hal.wait_tick() == Status::kOk) reads.push_back(hal.read_sample(sample));
  using enum Status;
  EXPECT_EQ(reads, (std::vector<Status>{kOk, kOk, kNoData, kNoData, kNoData, kOk}));
  EXPECT_EQ(sample.stamp_us, 50'000);
}

TEST(ReplayedHal, ALongGapCostsAsMuchAsOneOfSeconds) {
  // Whatever the gap, the row behind it is read by the tick nearest to its stamp: within half a period, never early.
  for (const double back_s : {10.0, 10.0049, 10.0051, 1e5, 1.7e9 + 0.003}) {
    const Record record = rows({0.0, 0.01, back_s, back_s + 0.01});
    ReplayedHal hal(record);
    Sample sample;
    std::vector<Status> reads;
    while (hal.wait_tick() == Status::kOk) reads.push_back(hal.read_sample(sample));
    using enum Status;
    const auto read = [](Status status) { return status == kOk; };
    EXPECT_EQ(std::count_if(reads.begin(), reads.end(), read), 4);
    EXPECT_EQ(reads.size(), 4U + ReplayedHal::kLongestGapTicks) << back_s;
    for (std::size_t i = 1; i < reads.size(); ++i) EXPECT_LT(hal.times_us()[i - 1], hal.times_us()[i]);
  }
}

TEST(ReplayedHal, ARowBelongsToTheNearestTick) {
  const Record record = rows({0.0, 0.0149, 0.0252});
  ReplayedHal hal(record);
  Sample sample;
  std::vector<Status> reads;
  while (hal.wait_tick() == Status::kOk) reads.push_back(hal.read_sample(sample));
  using enum Status;
  EXPECT_EQ(reads, (std::vector<Status>{kOk, kOk, kNoData, kOk}));
}

TEST(ReplayedHal, RowsThatShareATickAreReadOneATick) {
  const Record record = rows({0.0, 0.001, 0.002});
  ReplayedHal hal(record);
  Sample sample;
  for (int k = 0; k < 3; ++k) {
    ASSERT_EQ(hal.wait_tick(), Status::kOk);
    ASSERT_EQ(hal.read_sample(sample), Status::kOk);
    EXPECT_EQ(sample.stamp_us, k * 1000);
  }
  EXPECT_EQ(hal.wait_tick(), Status::kEndOfStream);
}

TEST(ReplayedHal, AValueBeyondTheIntegersIsInvalid) {
  Record record = rows({0.0, 0.01, 0.02});
  record.angle_rad[0] = 2148.0;
  record.torque_driver_nm[1] = -std::numeric_limits<double>::infinity();
  record.torque_motor_nm[2] = std::numeric_limits<double>::quiet_NaN();
  ReplayedHal hal(record);
  Sample sample;
  for (const std::uint8_t lost : {kAngleValid, kTorqueDriverValid, kTorqueMotorValid}) {
    ASSERT_EQ(hal.wait_tick(), Status::kOk);
    ASSERT_EQ(hal.read_sample(sample), Status::kOk);
    EXPECT_EQ(sample.valid_bits, kAllChannelsValid & ~lost);
  }
}

TEST(ReplayedHal, HandsOutTheChannelsThatAreThere) {
  Record record = rows({0.0, 0.01});
  record.channels = kAngleValid | kTorqueBarValid | kTorqueRimValid | kProbeValid;
  record.torque_bar_nm = {1.0, 5e6};
  record.torque_rim_nm = {-2.0, 0.0};
  record.probe_nm = {0.25, 0.0};
  ReplayedHal hal(record);
  Sample sample;
  ASSERT_EQ(hal.wait_tick(), Status::kOk);
  ASSERT_EQ(hal.read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.valid_bits, record.channels);
  EXPECT_EQ(sample.torque_bar_mnm, 1000);
  EXPECT_EQ(sample.torque_rim_mnm, -2000);
  EXPECT_EQ(sample.probe_mnm, 250);
  EXPECT_EQ(sample.torque_motor_mnm, 0);
  ASSERT_EQ(hal.wait_tick(), Status::kOk);
  ASSERT_EQ(hal.read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.valid_bits, record.channels & ~kTorqueBarValid);
}

TEST(ReplayedHal, CountsAnotherMachineInOtherUnits) {
  Record record = rows({0.0});
  record.torque_driver_nm[0] = 1234.5;
  record.angle_rad[0] = 0.0375;
  ReplayedHal hal(record, 100.0, 0.1);
  Sample sample;
  ASSERT_EQ(hal.wait_tick(), Status::kOk);
  ASSERT_EQ(hal.read_sample(sample), Status::kOk);
  EXPECT_EQ(sample.torque_driver_mnm, 12345);
  EXPECT_EQ(sample.angle_urad, 375'000);
}

TEST(ReplayedHal, CannotGrantAProbe) {
  const Record record = rows({0.0});
  ReplayedHal hal(record);
  EXPECT_EQ(hal.request_probe_torque(0), Status::kOk);
  EXPECT_EQ(hal.request_probe_torque(1), Status::kOutOfRange);
}

TEST(ReplayedHal, AnEmptyRecordEndsAtOnce) {
  const Record record;
  ReplayedHal hal(record);
  EXPECT_EQ(hal.wait_tick(), Status::kEndOfStream);
}

}  // namespace
}  // namespace steerid
