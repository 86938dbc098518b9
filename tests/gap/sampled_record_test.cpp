// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is kept of a record of hours.
#include "gap/preparation/sampled_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "gap/likelihood/held_out_split.hpp"

namespace steerid::gap {
namespace {

Record counting_record(std::size_t rows) {
  Record record;
  for (std::size_t i = 0; i < rows; ++i) {
    record.time_s.push_back(0.01 * static_cast<double>(i));
    record.torque_driver_nm.push_back(static_cast<double>(i));
    record.torque_motor_nm.push_back(2.0 * static_cast<double>(i));
    record.angle_rad.push_back(3.0 * static_cast<double>(i));
  }
  return record;
}

TEST(SampledRecord, AShortRecordIsLeftAlone) {
  const Record record = counting_record(60'000);
  EXPECT_EQ(sampled_record(record).angle_rad, record.angle_rad);
}

TEST(SampledRecord, OfHoursTenMinutesAreKeptFromTheWholeCourse) {
  constexpr std::size_t kRows = 1'080'000;  // three hours
  const Record kept = sampled_record(counting_record(kRows));
  EXPECT_LE(kept.size(), 60'000U);
  EXPECT_GT(kept.size(), 55'000U);
  EXPECT_TRUE(std::is_sorted(kept.time_s.begin(), kept.time_s.end()));
  for (std::size_t i = 0; i < kept.size(); ++i) {  // rows stay whole
    ASSERT_NEAR(kept.torque_driver_nm[i], 100 * kept.time_s[i], 1e-6);
    ASSERT_EQ(kept.torque_motor_nm[i], 2 * kept.torque_driver_nm[i]);
    ASSERT_EQ(kept.angle_rad[i], 3 * kept.torque_driver_nm[i]);
  }
  // Every twelfth of the course is met, in every part of the split.
  std::array<std::array<int, 3>, 12> met{};
  for (const Block& block : held_out_split(kept)) {
    const double share = kept.time_s[block.first] / (0.01 * kRows);
    met[static_cast<std::size_t>(12 * share)][static_cast<std::size_t>(block.role)] += 1;
  }
  for (const auto& twelfth : met) {
    for (const int blocks : twelfth) EXPECT_GT(blocks, 0);
  }
}

}  // namespace
}  // namespace steerid::gap
