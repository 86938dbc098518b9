// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The blind generator and the project's own plant share no code. Where both know an effect they must agree on what it
// does and on what its parameters mean: the plant, run free with the generator's own numbers on a record without noise,
// has to land on the record.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "blind_bench.hpp"
#include "plant/effects/vocabulary.hpp"
#include "plant/free_run.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

double nrmse(const Record& record, std::span<const double> angle_rad) {
  double misses = 0, mean = 0, spread = 0;
  const auto n = static_cast<double>(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    mean += record.angle_rad[i] / n;
    misses += std::pow(record.angle_rad[i] - angle_rad[i], 2) / n;
  }
  for (const double angle : record.angle_rad) spread += (angle - mean) * (angle - mean) / n;
  return std::sqrt(misses / spread);
}

struct Drawn {
  BlindBench bench;
  blind::Torques torques;
};

Drawn drawn_drive(blind::Task task, std::uint64_t seed) {
  Drawn out;
  out.bench.run = {.lead_in_s = 8, .duration_s = 40};
  if (task == blind::Task::kActive) out.bench.arm = {0.1, 1.0, 9.0};
  blind::Draw draw(seed);
  out.torques = blind::draw_torques(task, out.bench.arm, out.bench.run, draw);
  return out;
}

Record drive(const Drawn& drawn) {
  return blind::simulate(drawn.bench.arm, drawn.torques, drawn.bench.elements, drawn.bench.sensors, drawn.bench.run, 1)
      .record;
}

WheelArm wheel(const blind::Arm& arm) { return {arm.inertia_kgm2, arm.damping_nms_per_rad, arm.stiffness_nm_per_rad}; }

TEST(BlindAgainstPlant, LinearDrivesAgree) {
  const std::uint64_t base = seed(41);
  for (const blind::Task task : {blind::Task::kPassive, blind::Task::kActive, blind::Task::kProbe}) {
    const Drawn drawn = drawn_drive(task, base);
    const Record record = drive(drawn);
    FreeRun run(record);
    // 100 Hz samples of torques below 7 Hz, the tremor to 10: the spline between them errs by some 1e-4 of the
    // fastest tones, most of which the wheel does not follow.
    EXPECT_LT(nrmse(record, run(wheel(drawn.bench.arm))), 1e-4) << blind::name(task);
  }
}

/// Part of the effect that the two may differ by: bristles that bend where the plant's friction is rigid, the rounding
/// where the two fall on either side of a step, the memory from before the record. Measured: 0.04 and less.
double may_be_left(std::string_view id) {
  if (id == "torque_saturation") return 0.3;  // a replay cannot know clipped peaks
  if (id == "stribeck_friction") return 0.2;  // the excess at breakaway acts while the bristles bend
  return 0.1;
}

/// Drives with numbers as they are drawn and then `changed`, and replays that through the plant.
void means_the_same(
    const blind::Kind& kind, std::uint64_t index,
    const std::function<void(blind::Numbers&)>& changed = [](blind::Numbers&) {}) {
  const std::uint64_t base = seed(17);
  Drawn drawn = drawn_drive(kind.needs_large_angles ? blind::Task::kActive : blind::Task::kProbe, base + index);
  const Record twin = drive(drawn);
  blind::Setting& setting = drawn.bench.setting;
  setting.arm = drawn.bench.arm;
  setting.duration_s = drawn.bench.run.duration_s;
  setting.torque_rms_nm = 1.8;
  setting.torque_peak_nm = 4.5;
  for (const double angle : twin.angle_rad) {
    setting.angle_peak_rad = std::max(setting.angle_peak_rad, std::abs(angle));
  }
  setting.angle_rms_rad = setting.angle_peak_rad / 3;
  setting.rate_rms_rad_s = 10 * setting.angle_rms_rad;
  blind::Draw draw(base, index);
  blind::Numbers numbers = kind.draw(draw, setting);
  changed(numbers);
  drawn.bench.with(kind.id, numbers);
  const Record record = drive(drawn);

  Effect effect(find_effect(kind.id));
  for (const auto& [name, value] : numbers.all()) effect.at(name) = value;
  FreeRun run(record);
  const double without = nrmse(record, run(wheel(drawn.bench.arm)));
  const double with = nrmse(record, run(wheel(drawn.bench.arm), std::vector{effect}));
  EXPECT_LT(with, may_be_left(kind.id) * without) << kind.id << ": " << with << " of " << without;
  EXPECT_GT(without, 1e-3) << kind.id;
}

class SharedEffect : public testing::TestWithParam<std::size_t> {};

TEST_P(SharedEffect, MeansTheSame) {
  const blind::Kind& kind = *blind::vocabulary()[GetParam()];
  if (kind.id == "unmeasured_torque") GTEST_SKIP() << "its course is drawn: there is nothing to replay";
  means_the_same(kind, GetParam());
}

TEST(SharedHysteresis, MeansTheSameOfEitherKind) {
  const auto kinds = blind::vocabulary();
  const auto* const* found =
      &*std::ranges::find(kinds, "presliding_hysteresis", [](const blind::Kind* kind) { return kind->id; });
  for (const double loop_shape : {0.0, 1.0}) {
    for (const std::uint64_t index : {30U, 31U}) {
      SCOPED_TRACE(testing::Message() << "loop_shape " << loop_shape << ", draw " << index);
      means_the_same(**found, index, [&](blind::Numbers& numbers) { numbers.at("loop_shape") = loop_shape; });
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BlindAgainstPlant, SharedEffect, testing::Range<std::size_t>(0, blind::vocabulary().size()),
                         [](const auto& which) { return std::string(blind::vocabulary()[which.param]->id); });

}  // namespace
}  // namespace steerid::test
