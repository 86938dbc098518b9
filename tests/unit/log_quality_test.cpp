// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "log/record_quality.hpp"

namespace steerid::test {
namespace {

Record with_stamps(std::vector<double> time_s) {
  Record record;
  record.torque_driver_nm.resize(time_s.size());
  record.torque_motor_nm.resize(time_s.size());
  record.angle_rad.resize(time_s.size());
  record.time_s = std::move(time_s);
  return record;
}

/// Stamps at the given intervals in ms.
Record with_intervals(const std::vector<int>& intervals_ms) {
  int stamp_ms = 0;
  std::vector<double> time_s = {0.0};
  for (const int interval_ms : intervals_ms) time_s.push_back((stamp_ms += interval_ms) / 1e3);
  return with_stamps(std::move(time_s));
}

TEST(RecordQuality, OfNothing) {
  const RecordQuality quality = quality_of({});
  EXPECT_EQ(quality.rows, 0U);
  EXPECT_EQ(quality.median_period_s, 0.0);
  EXPECT_TRUE(gap_free_rows({}).empty());
}

TEST(RecordQuality, OneSampleIsOneSegment) {
  const Record record = with_stamps({3.0});
  EXPECT_EQ(quality_of(record).rows, 1U);
  ASSERT_EQ(gap_free_rows(record).size(), 1U);
  EXPECT_EQ(gap_free_rows(record)[0].size(), 1U);
}

TEST(RecordQuality, FourPeriodsAreNoGapAndFiveAre) {
  const Record record = with_intervals({10, 10, 20, 10, 40, 10, 10, 50, 10, 10, 60, 10});
  const RecordQuality quality = quality_of(record);
  EXPECT_NEAR(quality.median_period_s, 0.010, 1e-12);
  ASSERT_EQ(quality.gaps.size(), 2U);
  EXPECT_NEAR(quality.gaps[0].start_s, 0.110, 1e-12);
  EXPECT_NEAR(quality.gaps[0].length_s, 0.050, 1e-12);
  EXPECT_NEAR(quality.gaps[1].start_s, 0.180, 1e-12);
  EXPECT_NEAR(quality.gaps[1].length_s, 0.060, 1e-12);

  const std::vector<GapFreeRows> found = gap_free_rows(record);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].begin, 0U);
  EXPECT_EQ(found[0].end, 8U);
  EXPECT_EQ(found[1].begin, 8U);
  EXPECT_EQ(found[1].end, 11U);
  EXPECT_EQ(found[2].begin, 11U);
  EXPECT_EQ(found[2].end, record.size());
}

/// At 50 Hz four periods are long beside a wheel's movement, and at 1 kHz short beside the filter.
TEST(RecordQuality, GapsOfSlowAndOfFastLogsAreAsShortAsTheyWere) {
  const auto gaps = [](const std::vector<int>& intervals_ms) { return quality_of(with_intervals(intervals_ms)).gaps; };
  EXPECT_TRUE(gaps({20, 20, 20, 49, 20, 20}).empty());
  EXPECT_EQ(gaps({20, 20, 20, 51, 20, 20}).size(), 1U);
  EXPECT_TRUE(gaps({1, 1, 1, 10, 1, 1}).empty());
  EXPECT_EQ(gaps({1, 1, 1, 11, 1, 1}).size(), 1U);
}

TEST(RecordQuality, JitterIsTheNinetyFifthPercentileWithoutGaps) {
  // Of 100 intervals 50 are right, 45 are 1 ms off, 4 are 3 ms off, and one is a gap.
  std::vector<int> intervals(50, 10);
  intervals.insert(intervals.end(), 25, 11);
  intervals.insert(intervals.end(), 20, 9);
  intervals.insert(intervals.end(), 4, 13);
  intervals.push_back(500);
  EXPECT_NEAR(quality_of(with_intervals(intervals)).jitter_s, 0.001, 1e-12);
  // With 6 more of 3 ms they are more than the worst 5 %.
  intervals.insert(intervals.end(), 6, 13);
  EXPECT_NEAR(quality_of(with_intervals(intervals)).jitter_s, 0.003, 1e-12);
}

}  // namespace
}  // namespace steerid::test
