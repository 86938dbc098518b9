// Defects of a record, made by hand, and their absence.
#include "gap/record_defects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gap/drawn_drive.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

const RecordDefect* found(const RecordDefects& defects, std::string_view id) {
  const auto it = std::ranges::find_if(defects.found, [&](const auto& one) { return one.effect.type->id == id; });
  return it == defects.found.end() ? nullptr : &*it;
}

Record usual(std::uint64_t seed) {
  Record record = test::drive({}, seed);
  for (double& angle : record.angle_rad) angle = 0.0005 * std::round(angle / 0.0005);  // 0.03 degrees
  return record;
}

TEST(RecordDefects, AUsualRecordHasNone) { EXPECT_TRUE(record_defects(usual(test::seed(21))).found.empty()); }

TEST(RecordDefects, LostSamplesAreCountedAndRepaired) {
  const Record whole = usual(test::seed(22));
  Record record = whole;
  test::Noise chance(test::seed(23));
  for (std::size_t i = 1; i < record.size(); ++i) {
    if (chance.uniform() < 0.08) record.angle_rad[i] = record.angle_rad[i - 1];
  }
  const RecordDefects defects = record_defects(record);
  const RecordDefect* loss = found(defects, "sample_loss");
  ASSERT_NE(loss, nullptr);
  EXPECT_EQ(defects.found.size(), 1U);
  EXPECT_NEAR(loss->effect.at("loss_probability"), 0.08, 0.03);
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    before += std::pow(record.angle_rad[i] - whole.angle_rad[i], 2);
    after += std::pow(defects.repaired.angle_rad[i] - whole.angle_rad[i], 2);
  }
  EXPECT_LT(after, 0.1 * before);
}

/// A play in the sensor repeats, too, but only after reversals: nothing of it is lost.
TEST(RecordDefects, APlayOfTheSensorLosesNoSamples) {
  test::DrawnDrive what;
  what.angle_noise_rad = 0;
  Record record = test::drive(what, test::seed(27));
  constexpr double kHalfPlay = 0.01;
  double held = record.angle_rad[0];
  int repeats = 0;
  for (double& angle : record.angle_rad) {
    const double before = held;
    held = std::clamp(held, angle - kHalfPlay, angle + kHalfPlay);
    repeats += held == before ? 1 : 0;
    angle = held;
  }
  EXPECT_GT(repeats, static_cast<int>(record.size()) / 20);
  EXPECT_EQ(found(record_defects(record), "sample_loss"), nullptr);
}

TEST(RecordDefects, ACoarseAngleHasItsStep) {
  Record record = test::drive({}, test::seed(24));
  for (double& angle : record.angle_rad) angle = 0.02 * std::round(angle / 0.02);
  const RecordDefects defects = record_defects(record);
  const RecordDefect* coarse = found(defects, "coarse_quantization");
  ASSERT_NE(coarse, nullptr);
  EXPECT_EQ(defects.found.size(), 1U);
  EXPECT_NEAR(coarse->effect.at("step_rad"), 0.02, 1e-6);
}

TEST(RecordDefects, AClippedTorqueHasItsLimit) {
  Record record = usual(test::seed(25));
  for (double& torque : record.torque_motor_nm) torque = std::clamp(torque, -3.0, 3.0);
  test::Noise noise(test::seed(26));
  for (double& torque : record.torque_motor_nm) torque += 0.006 * noise();
  const RecordDefects defects = record_defects(record);
  const RecordDefect* clipped = found(defects, "torque_saturation");
  ASSERT_NE(clipped, nullptr);
  EXPECT_NEAR(clipped->effect.at("limit_nm"), 3.0, 0.03);
}

}  // namespace
}  // namespace steerid
