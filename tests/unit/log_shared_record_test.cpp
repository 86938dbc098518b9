// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The measured records read with the columns that they have. Expected values are copied from the files' text by eye,
// or are facts of their making (rate, length).
#include <gtest/gtest.h>

#include "log/log_reader.hpp"
#include "log/resample.hpp"
#include "support/shared_data.hpp"

namespace steerid::test {
namespace {

TEST(SharedRecord, EmpsPositionAndForce) {
  STEERID_SHARED_OR_SKIP(path, "data/emps.csv");
  RecordQuality noticed;
  const LogFormat format{.columns = parse_columns("torque_motor=force_n,angle=position_m"),
                         .reversed = parse_sign("torque_motor")};
  const Record record = read_log(path, format, &noticed);
  ASSERT_EQ(record.size(), 24841U);
  EXPECT_EQ(record.angle_rad[1], 1.43e-05);
  EXPECT_EQ(record.torque_motor_nm[1], -92.264663);
  EXPECT_EQ(record.net_torque_nm(1), 92.264663);
  EXPECT_NEAR(noticed.median_period_s, 1e-3, 1e-12);
  EXPECT_LT(noticed.jitter_s, 1e-9);
  EXPECT_TRUE(noticed.gaps.empty());
  const Resampled resampled = resample_100hz(record);
  EXPECT_TRUE(resampled.filtered);
  EXPECT_EQ(resampled.dropped_stretches, 0U);
  EXPECT_EQ(resampled.record.size(), 2455U);  // 0.15 to 24.69 s
}

TEST(SharedRecord, HandlebarHasJitter) {
  STEERID_SHARED_OR_SKIP(path, "data/handlebar_multisine.csv");
  RecordQuality noticed;
  const Record record = read_log(path, {.columns = parse_columns("torque_motor=motor_torque_nm")}, &noticed);
  ASSERT_EQ(record.size(), 19805U);
  EXPECT_EQ(record.time_s[2], 0.002030);
  EXPECT_EQ(record.torque_motor_nm[0], 0.0210571);
  EXPECT_EQ(record.angle_rad[0], 4.133675e-05);
  // Stamps are rounded to 10 us, and the log shows steps between 0.87 and 1.13 ms.
  EXPECT_GE(noticed.jitter_s, 9.9e-6);
  EXPECT_LT(noticed.jitter_s, 1.3e-4);
  EXPECT_TRUE(noticed.gaps.empty());
  EXPECT_NEAR(resample_100hz(record).source_rate_hz, 1000.0, 0.5);
}

TEST(SharedRecord, AnkleWithItsSignReversed) {
  STEERID_SHARED_OR_SKIP(path, "data/ankle_perturbation.csv");
  RecordQuality noticed;
  const LogFormat format{.columns = parse_columns("torque_driver=torque_nm"), .reversed = parse_sign("torque_driver")};
  const Record record = read_log(path, format, &noticed);
  ASSERT_EQ(record.size(), 60000U);
  EXPECT_EQ(record.angle_rad[0], 0.17775881);
  EXPECT_EQ(record.torque_driver_nm[0], 2.9337716);
  EXPECT_EQ(noticed.notes, std::vector<std::string>{"no column for torque_motor: taken as zero"});
}

TEST(SharedRecord, ASimulatedDriveNeedsNoOptionsAndNoResampling) {
  STEERID_SHARED_OR_SKIP(path, "gap/dev/cases/case000/log.csv");
  const Record record = read_log(path);
  EXPECT_EQ(record.size(), 10000U);
  const Resampled resampled = resample_100hz(record);
  EXPECT_TRUE(resampled.untouched);
  EXPECT_EQ(resampled.record.angle_rad, record.angle_rad);
}

}  // namespace
}  // namespace steerid::test
