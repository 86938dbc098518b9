// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Record effects both ways: against closed forms forward, and forward then back in a replay.
#include <gtest/gtest.h>

#include <complex>
#include <set>

#include "plant/free_run.hpp"
#include "plant_drive.hpp"

namespace steerid::test {
namespace {

using namespace effect;

constexpr WheelArm kWheel{0.11, 1.5, 22.7};

/// The wheel's answer to a sine in the steady state, at time t.
double steady(double amplitude, double hz, double t) {
  const std::complex<double> s(0, kTwoPi * hz);
  return amplitude * std::imag(std::exp(s * t) / (0.11 * s * s + 1.5 * s + 22.7));
}

TEST(Delay, ShiftsASineByExactlyItself) {
  const double hz = 4.3;
  for (const double delay_s : {0.0037, 0.06, -0.0037, -0.06}) {
    const std::vector<Effect> effects{with(delay, {{"delay_s", delay_s}})};
    const Torque sine{{{2, hz, 0}}};
    const Record record = stream(kWheel, effects, sine, {}, 10);
    for (std::size_t i = 500; i < record.size(); ++i) {
      const double t = record.time_s[i];
      // d > 0: the angle is late. d < 0: the torque is.
      ASSERT_NEAR(record.angle_rad[i], steady(2, hz, t - std::max(delay_s, 0.0)), 1e-5);
      ASSERT_NEAR(record.torque_driver_nm[i], sine.at(t + std::min(delay_s, 0.0)), 2e-4);
    }
  }
}

TEST(Lag, TurnsAndShrinksASineAsItsTransferFunctionSays) {
  const double hz = 3.1;
  for (const double constant : {0.002, 0.025, 0.3}) {
    const std::vector<Effect> effects{with(lag, {{"time_constant_s", constant}})};
    const Record record = stream(kWheel, effects, {{{2, hz, 0}}}, {}, 12);
    const std::complex<double> s(0, kTwoPi * hz);
    const std::complex<double> answer = 2.0 / (0.11 * s * s + 1.5 * s + 22.7) / (1.0 + s * constant);
    for (std::size_t i = 1000; i < record.size(); ++i) {
      ASSERT_NEAR(record.angle_rad[i], std::imag(answer * std::exp(s * record.time_s[i])), 1e-5) << constant;
    }
  }
}

TEST(TorqueBias, IsAddedToTheDriversChannelOnly) {
  const std::vector<Effect> effects{with(torque_bias, {{"bias_nm", -0.4}})};
  const Record record = stream(kWheel, effects, steering(), probe(), 1);
  for (std::size_t i = 0; i < record.size(); ++i) {
    EXPECT_EQ(record.torque_driver_nm[i], steering().at(record.time_s[i]) - 0.4);
    EXPECT_EQ(record.torque_motor_nm[i], probe().at(record.time_s[i]));
  }
}

TEST(TorqueDrift, ReachesSixtyThreePercentAfterItsTimeConstant) {
  const std::vector<Effect> effects{with(torque_drift, {{"drift_nm", 2}, {"time_constant_s", 5}})};
  const Record record = stream(kWheel, effects, {}, {}, 20);
  EXPECT_EQ(record.torque_driver_nm.front(), 0.0);
  EXPECT_NEAR(record.torque_driver_nm[500], 2 * (1 - std::exp(-1)), 1e-12);
  EXPECT_NEAR(record.torque_driver_nm.back(), 2 * (1 - std::exp(-4)), 1e-12);
}

TEST(CoarseQuantization, LeavesMultiplesOfItsStepWithinHalfAStep) {
  const std::vector<Effect> effects{with(coarse_quantization, {{"step_rad", 0.04}})};
  const Record coarse = stream(kWheel, effects, steering(), probe(), 20);
  const Record fine = stream(kWheel, {}, steering(), probe(), 20);
  std::set<long> readings;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    EXPECT_LE(std::abs(coarse.angle_rad[i] - fine.angle_rad[i]), 0.02 + 1e-12);
    EXPECT_NEAR(coarse.angle_rad[i], 0.04 * std::round(coarse.angle_rad[i] / 0.04), 1e-12);
    readings.insert(std::lround(coarse.angle_rad[i] / 0.04));
  }
  EXPECT_GT(readings.size(), 4U);
}

TEST(TorqueSaturation, ClipsBothChannelsAndLeavesTheWheelAlone) {
  const std::vector<Effect> effects{with(torque_saturation, {{"limit_nm", 2}})};
  const Record clipped = stream(kWheel, effects, steering(4), probe(), 20);
  const Record whole = stream(kWheel, {}, steering(4), probe(), 20);
  EXPECT_EQ(clipped.angle_rad, whole.angle_rad);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(clipped.torque_driver_nm[i], std::clamp(whole.torque_driver_nm[i], -2.0, 2.0));
    EXPECT_EQ(clipped.torque_motor_nm[i], std::clamp(whole.torque_motor_nm[i], -2.0, 2.0));
  }
}

TEST(SampleLoss, LosesItsShareAndRepeatsTheLastValue) {
  const std::vector<Effect> effects{with(sample_loss, {{"loss_probability", 0.2}})};
  const Record lossy = stream(kWheel, effects, steering(), probe(), 200, {}, 11);
  const Record whole = stream(kWheel, {}, steering(), probe(), 200);
  std::size_t lost = 0;
  for (std::size_t i = 1; i < whole.size(); ++i) {
    const bool repeated = lossy.angle_rad[i] == lossy.angle_rad[i - 1];
    lost += repeated ? 1 : 0;
    EXPECT_TRUE(repeated || lossy.angle_rad[i] == whole.angle_rad[i]);
  }
  // 20000 draws: 4000 lost with a deviation of sqrt(20000 x 0.2 x 0.8) = 57; four of them.
  EXPECT_NEAR(static_cast<double>(lost), 4000, 228);
}

TEST(Seeds, RepeatBitForBitAndDiffer) {
  const std::vector<Effect> effects{with(unmeasured_torque), with(sample_loss)};
  const Record one = stream(kWheel, effects, steering(), probe(), 10, {}, 1);
  EXPECT_EQ(one.angle_rad, stream(kWheel, effects, steering(), probe(), 10, {}, 1).angle_rad);
  EXPECT_NE(one.angle_rad, stream(kWheel, effects, steering(), probe(), 10, {}, 2).angle_rad);
}

/// What one effect may leave between a streamed record and its replay, beyond the integration.
double allowed(const EffectType& type) {
  if (&type == &coarse_quantization) return 0.0501;  // a reading on the edge of a step may fall either way
  // A torque that bends between two samples is known to a hundredth; a wheel alone goes on by what is off for 0.3 s.
  if (&type == &hands_off) return 2e-3;
  return 2 * kTenthOfFloorRad;  // each run its own tenth
}

// Clipped peaks are rebuilt, not known: most of the error that taking the record at its word makes has to go.
TEST(TorqueSaturation, ReplayRebuildsTheProbesPeaks) {
  const std::vector<Effect> effects{with(torque_saturation, {{"limit_nm", 4}})};
  const Record record = stream(kWheel, effects, steering(2), probe(), 30);
  FreeRun run(record);
  const auto misfit = [&](std::span<const Effect> used) {
    const auto angle = run(kWheel, used, WheelState{});
    std::vector<double> difference;
    for (std::size_t i = 0; i < angle.size(); ++i) difference.push_back(angle[i] - record.angle_rad[i]);
    return rms(difference);
  };
  EXPECT_LT(misfit(effects), 0.25 * misfit({}));
}

/// All but torque_saturation, which no replay can undo to the last bit; it has the test above.
std::vector<const EffectType*> invertible() {
  std::vector<const EffectType*> types(effects().begin(), effects().end());
  std::erase(types, &torque_saturation);
  return types;
}

class RoundTrip : public ::testing::TestWithParam<const EffectType*> {};

// A drive simulated tick by tick with an effect, then replayed from its own record with the same effect: the same
// angle. Replayed without the effect it has to be visibly different, or the preset is no effect at all.
TEST_P(RoundTrip, ReplayOfAStreamedRecordGivesItsAngleBack) {
  const EffectType& type = *GetParam();
  Effect effect(type);
  if (type.takes_time_course)
    effect.time_course_nm = {0, 1, -1, 1, 0.5, 0, -1, 0.3, 1, -1, 0, 1, 1, -1, 0.5, 0, 0.2, -1, 1, 0, 1};
  // A torque that is gone from one sample to the next went at an instant between them that no record tells.
  if (&type == &hands_off) effect.at("fade_s") = 0.08;
  const std::vector<Effect> effects{effect};
  const WheelState start{0.03, 0.1};
  const Record record = stream(kWheel, effects, steering(9), probe(), 30, start);
  FreeRun run(record);
  // A replay with a delay starts before the record: let it find its own start, and look past the first seconds.
  const auto replayed = run(kWheel, effects, &type == &delay ? std::nullopt : std::optional(start));
  const std::size_t skip = &type == &delay ? 300 : 0;
  EXPECT_LT(
      worst_difference(replayed.subspan(skip, 2900 - skip), std::span(record.angle_rad).subspan(skip, 2900 - skip)),
      allowed(type));
  const auto without = run(kWheel, {}, start);
  // Ten times the sensor noise's standard error over this many samples would be 1e-4; a visible effect is far above.
  EXPECT_GT(worst_difference(without, record.angle_rad), 10 * kTenthOfFloorRad);
}

INSTANTIATE_TEST_SUITE_P(EveryEffect, RoundTrip, ::testing::ValuesIn(invertible()),
                         [](const auto& given) { return std::string(given.param->id); });

}  // namespace
}  // namespace steerid::test
