// The floor: noise levels read off channels with a drive on them, the split, and the rms that the floor leaves.
#include <gtest/gtest.h>

#include <cmath>

#include "gap/drawn_drive.hpp"
#include "gap/held_out_split.hpp"
#include "gap/noise_floor.hpp"
#include "gap/shrinkage.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

TEST(NoiseFloor, ReadsWhiteLevelsUnderADrive) {
  test::DrawnDrive what;
  what.duration_s = 100;
  const NoiseFloor floor = NoiseFloor::of(test::drive(what, test::seed(11)), what.wheel, 100);
  // The lowest of four bands, each of some 700 lines: 4 % below the mean at most, three times that allowed.
  EXPECT_NEAR(std::sqrt(floor.torque_variance), 0.02, 0.08 * 0.02);
  EXPECT_NEAR(std::sqrt(floor.angle_variance), 0.0006, 0.08 * 0.0006);
}

TEST(NoiseFloor, SlowTorqueHasUnitPower) {
  NoiseFloor floor;
  double sum = 0;
  constexpr int kLines = 100'000;
  for (int k = 0; k < kLines; ++k) sum += floor.slow_shape(50.0 * (k + 0.5) / kLines);
  // The mean over all frequencies of a sampled process is its variance; ending it at 1.3 Hz takes less than 1 %.
  EXPECT_NEAR(sum / kLines, 1.0, 0.01);
}

TEST(NoiseFloor, RmsOfAStaticWheelIsTorqueNoiseOverStiffness) {
  NoiseFloor floor;
  floor.angle_variance = 1e-6;
  floor.torque_variance = 0;
  floor.slow_variance = 0.01;
  floor.slow_corner_hz = 0.05;
  // Slow beside 2 Hz: the wheel follows, sd 0.1 Nm over 50 Nm/rad, and angle noise on top.
  const double expected = std::sqrt(1e-6 + std::pow(0.1 / 50, 2));
  EXPECT_NEAR(floor_rms_rad(floor, {0.1, 2.0, 50.0}, 0), expected, 0.01 * expected);
}

TEST(HeldOutSplit, PartsAreDisjointAndCoverTheWholeCourse) {
  Record record;
  for (int i = 0; i < 6000; ++i) record.time_s.push_back(0.01 * i);
  const std::vector<Block> blocks = held_out_split(record, 100);
  std::vector<int> owner(6000, 0);
  double report = 0;
  for (const Block& block : blocks) {
    for (std::size_t i = block.first; i < block.first + block.count; ++i) owner[i] += 1;
    if (block.role == Block::Role::kReport) report += static_cast<double>(block.count);
  }
  EXPECT_EQ(*std::max_element(owner.begin(), owner.end()), 1);
  EXPECT_NEAR(report / 6000, 0.25, 0.03);
  EXPECT_EQ(blocks.size(), 9U);  // three cycles of 20 s
}

TEST(HeldOutSplit, ShortRecordsGetShortBlocksAndTinyOnesNone) {
  Record record;
  for (int i = 0; i < 800; ++i) record.time_s.push_back(0.01 * i);
  EXPECT_EQ(held_out_split(record, 100).size(), 6U);
  record.time_s.resize(400);
  EXPECT_TRUE(held_out_split(record, 100).empty());
}

}  // namespace
}  // namespace steerid
