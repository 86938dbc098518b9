// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether a driver steers, by columns that are integrated by tests/support/steered_column.hpp.
#include "gap/preparation/steered_band.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "gap/column_record.hpp"
#include "plant/driving_torques.hpp"
#include "support/seed.hpp"

namespace steerid::gap {
namespace {

using test::record_of;
using test::SteeredColumn;

SteeredColumn steered(double intent_rad) {
  SteeredColumn column;
  column.probe_nm = 1.5;
  column.intent_rad = intent_rad;
  return column;
}

TEST(SteeredBand, OneWhoSteersIsToldWithTheSizeOfHisTorque) {
  const std::uint64_t seed = test::seed(700);
  for (const double intent_rad : {0.03, 0.05, 0.1}) {
    const auto band = steered_band(with_driving_torques(record_of(steered(intent_rad), seed)));
    ASSERT_TRUE(band) << intent_rad;
    EXPECT_GE(band->to_hz, 2);
    EXPECT_LE(band->to_hz, 3);
    // Four poles of 0.4 Hz leave less than two would, which is 0.05 of the rms; noise of the sensors is in it.
    EXPECT_GT(band->tail_nm, 0.001 * 22 * intent_rad);
    EXPECT_LT(band->tail_nm, 0.025 * 22 * intent_rad);
  }
}

/// At rest, stiffening, or away for a fifth of the record.
TEST(SteeredBand, OneWhoRestsIsNot) {
  const std::uint64_t seed = test::seed(710);
  SteeredColumn stiffens = steered(0);
  stiffens.stiffer_by = 2;
  stiffens.stiffer_from_s = 25;
  SteeredColumn leaves = steered(0);
  leaves.let_go_from_s = 20;
  leaves.let_go_for_s = 12;
  for (const SteeredColumn& column : {steered(0), steered(0.005), stiffens, leaves}) {
    EXPECT_FALSE(steered_band(with_driving_torques(record_of(column, seed)))) << column.stiffer_by;
  }
}

TEST(SteeredBand, WhereHisTorqueIsInAChannelOrNothingElseMovesTheWheelThereIsNone) {
  const std::uint64_t seed = test::seed(720);
  Record record = record_of(steered(0.05), seed);
  record.channels |= kTorqueDriverValid;
  EXPECT_FALSE(steered_band(with_driving_torques(record)));
  SteeredColumn alone = steered(0.05);
  alone.probe_nm = 0;
  EXPECT_FALSE(steered_band(with_driving_torques(record_of(alone, seed))));
}

}  // namespace
}  // namespace steerid::gap
