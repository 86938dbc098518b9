// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Every defect against its closed form, statistics against their sampling distribution (4.5 standard deviations).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "port/sample.hpp"
#include "sensors/sensor_channel.hpp"
#include "support/seed.hpp"

namespace steerid {
namespace {

using sensor::Channel;
using sensor::ChannelDefects;

constexpr double kSigmas = 4.5;
constexpr double kTick = 0.01;

struct Signal {
  std::function<double(double)> value;
  std::function<double(double)> slope;
};

Signal constant(double value) {
  return {[value](double) { return value; }, [](double) { return 0.0; }};
}
Signal ramp(double slope) {
  return {[slope](double t) { return slope * t; }, [slope](double) { return slope; }};
}
Signal sine(double frequency_hz) {
  const double w = 2.0 * std::numbers::pi * frequency_hz;
  return {[w](double t) { return std::sin(w * t); }, [w](double t) { return w * std::cos(w * t); }};
}

std::vector<Channel::Reading> readings(const ChannelDefects& defects, const Signal& signal, int count,
                                       std::uint64_t seed = 1) {
  Channel channel(defects, seed, 0);
  std::vector<Channel::Reading> out;
  for (int k = 0; k < count; ++k) {
    const double t0 = k * kTick;
    const double t1 = (k + 1) * kTick;
    channel.extend(Cubic::hermite(signal.value(t0), signal.slope(t0), signal.value(t1), signal.slope(t1), kTick));
    const std::int64_t instant_us = k * kTickPeriodUs;
    out.push_back(channel.convert(channel.analogue(instant_us), instant_us));
  }
  return out;
}

/// Largest error of the cubic between two ticks against the sine itself: (w dt)^4/384.
double cubic_error(double frequency_hz) { return std::pow(2.0 * std::numbers::pi * frequency_hz * kTick, 4) / 384.0; }

TEST(SensorChannel, WithoutDefectsIsExact) {
  const Signal signal = sine(3.0);
  const auto out = readings({}, signal, 1000);
  for (int k = 0; k < 1000; ++k) {
    ASSERT_EQ(out[static_cast<std::size_t>(k)].value, signal.value(k * kTick));
    ASSERT_TRUE(out[static_cast<std::size_t>(k)].valid);
  }
}

TEST(SensorChannel, NoiseHasItsStandardDeviationAndIsWhite) {
  constexpr int kCount = 200'000;
  constexpr double kSd = 0.03;
  ChannelDefects defects;
  defects.noise.sd = kSd;
  const auto out = readings(defects, constant(2.0), kCount, test::seed(10));
  double sum = 0;
  double squares = 0;
  double neighbours = 0;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double n = out[k].value - 2.0;
    sum += n;
    squares += n * n;
    if (k > 0) neighbours += n * (out[k - 1].value - 2.0);
  }
  EXPECT_NEAR(sum / kCount, 0.0, kSigmas * kSd / std::sqrt(kCount));
  EXPECT_NEAR(std::sqrt(squares / kCount), kSd, kSigmas * kSd / std::sqrt(2.0 * kCount));
  EXPECT_NEAR(neighbours / squares, 0.0, kSigmas / std::sqrt(kCount));
}

TEST(SensorChannel, ResolutionRoundsToTheNearestStep) {
  constexpr int kCount = 100'000;
  constexpr double kStep = 0.0005;
  ChannelDefects defects;
  defects.resolution.step = kStep;
  // A slope that visits the inside of a step evenly: the golden ratio's multiples.
  const double slope = kStep * std::numbers::phi / kTick;
  const auto out = readings(defects, ramp(slope), kCount);
  double squares = 0;
  for (int k = 0; k < kCount; ++k) {
    const double y = out[static_cast<std::size_t>(k)].value;
    const double error = y - slope * (k * kTick);
    ASSERT_LE(std::abs(error), kStep / 2 * (1 + 1e-9));
    ASSERT_NEAR(y / kStep, std::round(y / kStep), 1e-9);
    squares += error * error;
  }
  // An even grid of 1e5 points integrates e^2 to about 1e-5; the multiples of phi are about as even as a grid.
  EXPECT_NEAR(std::sqrt(squares / kCount) / (kStep / std::sqrt(12.0)), 1.0, 1e-4);
}

TEST(SensorChannel, GainAndBiasActBetweenOnsetAndEnd) {
  ChannelDefects defects;
  defects.gain = {.factor = 1.5, .during = {.onset_s = 1.0, .length_s = 2.0}};
  defects.bias = {.offset = 0.25, .drift_per_s = 0.125, .during = {.onset_s = 4.0, .length_s = 1.0}};
  const auto out = readings(defects, constant(2.0), 700);
  const auto at = [&](double t) { return out[static_cast<std::size_t>(std::lround(t / kTick))].value; };
  EXPECT_EQ(at(0.99), 2.0);
  EXPECT_EQ(at(1.00), 3.0);
  EXPECT_EQ(at(2.99), 3.0);
  EXPECT_EQ(at(3.00), 2.0);
  EXPECT_EQ(at(4.00), 2.25);
  EXPECT_DOUBLE_EQ(at(4.50), 2.25 + 0.5 * 0.125);
  EXPECT_EQ(at(5.00), 2.0);
}

TEST(SensorChannel, SaturationClipsBothWays) {
  ChannelDefects defects;
  defects.saturation.limit = 0.5;
  const Signal signal = sine(1.0);
  const auto out = readings(defects, signal, 200);
  for (int k = 0; k < 200; ++k) {
    const double x = signal.value(k * kTick);
    ASSERT_EQ(out[static_cast<std::size_t>(k)].value, x > 0.5 ? 0.5 : x < -0.5 ? -0.5 : x);
  }
}

TEST(SensorChannel, DelayShiftsByAnyMicrosecond) {
  const Signal signal = sine(5.0);
  for (const std::int64_t delay_us : {0L, 1L, 4'321L, 10'000L, 25'000L, 123'456L, 500'000L}) {
    ChannelDefects defects;
    defects.delay.delay_us = delay_us;
    const auto out = readings(defects, signal, 400);
    for (int k = 0; k < 400; ++k) {
      const double t = k * kTick - static_cast<double>(delay_us) * 1e-6;
      // Before the start the signal stood at its first value, sin 0.
      const double expected = t < 0 ? 0.0 : signal.value(t);
      ASSERT_NEAR(out[static_cast<std::size_t>(k)].value, expected, 1.01 * cubic_error(5.0)) << delay_us << ' ' << k;
    }
  }
}

TEST(SensorChannel, LagHasTheGainAndPhaseOfAFirstOrderFilter) {
  for (const double time_constant_s : {0.0005, 0.004, 0.05, 1.0}) {
    for (const double frequency_hz : {0.25, 1.0, 5.0}) {
      ChannelDefects defects;
      defects.lag.time_constant_s = time_constant_s;
      // Whole cycles after 20 time constants, when e^-20 = 2e-9 of the start is left.
      const int settle = 100 * static_cast<int>(std::ceil(20 * time_constant_s + 1));
      const int count = 400;
      const auto out = readings(defects, sine(frequency_hz), settle + count);
      const double w = 2.0 * std::numbers::pi * frequency_hz;
      double in_phase = 0;
      double quadrature = 0;
      for (int k = settle; k < settle + count; ++k) {
        const double y = out[static_cast<std::size_t>(k)].value;
        in_phase += 2.0 / count * y * std::sin(w * k * kTick);
        quadrature += 2.0 / count * y * std::cos(w * k * kTick);
      }
      // 1/(1 + i w T) = (1 - i w T)/(1 + w^2 T^2)
      const double denominator = 1.0 + w * w * time_constant_s * time_constant_s;
      const double limit = cubic_error(frequency_hz) + 1e-8;
      EXPECT_NEAR(in_phase, 1.0 / denominator, limit) << time_constant_s << ' ' << frequency_hz;
      EXPECT_NEAR(quadrature, -w * time_constant_s / denominator, limit) << time_constant_s << ' ' << frequency_hz;
    }
  }
}

TEST(SensorChannel, LagAndDelayOfARampAddUp) {
  ChannelDefects defects;
  defects.lag.time_constant_s = 0.02;
  defects.delay.delay_us = 33'300;
  const auto out = readings(defects, ramp(3.0), 300);
  // A ramp comes late by delay plus time constant once e^(-t/T) is gone: at 2 s it is 1e-43.
  for (int k = 200; k < 300; ++k) {
    ASSERT_NEAR(out[static_cast<std::size_t>(k)].value, 3.0 * (k * kTick - 0.0333 - 0.02), 1e-12);
  }
}

TEST(SensorChannel, DropoutLosesItsShareInRunsOfItsLength) {
  for (const double mean_run : {1.0, 4.0}) {
    constexpr double kFraction = 0.1;
    constexpr int kCount = 400'000;
    ChannelDefects defects;
    defects.dropout = {.fraction = kFraction, .mean_run = mean_run, .flagged = true, .during = {}};
    const auto out = readings(defects, ramp(1.0), kCount, test::seed(11));
    int lost = 0;
    int runs = 0;
    for (std::size_t k = 1; k < out.size(); ++k) {
      if (!out[k].valid) {
        ++lost;
        if (out[k - 1].valid) ++runs;
        ASSERT_EQ(out[k].value, out[k - 1].value);
      } else {
        ASSERT_EQ(out[k].value, static_cast<double>(k) * kTick);
      }
    }
    // A two-state chain remembers with r = P(lost|lost) - P(lost|good): the variance of its mean grows by (1+r)/(1-r).
    const double start = kFraction / (mean_run * (1 - kFraction));
    const double memory = (1 - 1 / mean_run) - start;
    const double sd = std::sqrt(kFraction * (1 - kFraction) / kCount * (1 + memory) / (1 - memory));
    EXPECT_NEAR(static_cast<double>(lost) / kCount, kFraction, kSigmas * sd);
    // Geometric run lengths: variance mean (mean - 1).
    const double run_sd = std::sqrt(mean_run * (mean_run - 1) / runs);
    EXPECT_NEAR(static_cast<double>(lost) / runs, mean_run, kSigmas * run_sd + 1.0 / runs);
  }
}

TEST(SensorChannel, UnflaggedDropoutRepeatsInSilence) {
  ChannelDefects defects;
  defects.dropout = {.fraction = 0.3, .mean_run = 2, .flagged = false, .during = {}};
  const auto out = readings(defects, ramp(1.0), 1000, test::seed(12));
  int repeated = 0;
  for (std::size_t k = 1; k < out.size(); ++k) {
    ASSERT_TRUE(out[k].valid);
    if (out[k].value == out[k - 1].value) ++repeated;
  }
  EXPECT_GT(repeated, 200);  // 300 expected, standard deviation below 20
  EXPECT_LT(repeated, 400);
}

TEST(SensorChannel, StuckRepeatsTheLastValueAndComesBack) {
  ChannelDefects defects;
  defects.noise.sd = 0.1;
  defects.stuck.during = {.onset_s = 2.0, .length_s = 0.5};
  const std::uint64_t seed = test::seed(13);
  const auto out = readings(defects, ramp(1.0), 400, seed);
  defects.stuck.during.length_s = 0.0;
  const auto healthy = readings(defects, ramp(1.0), 400, seed);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const bool stuck = k >= 200 && k < 250;
    ASSERT_EQ(out[k].value, stuck ? healthy[199].value : healthy[k].value) << k;
  }
}

TEST(SensorChannel, MeetsTheDefectsInOrder) {
  ChannelDefects defects;
  defects.gain.factor = 2.0;
  defects.bias.offset = 1.0;
  defects.saturation.limit = 2.5;
  defects.resolution.step = 0.4;
  // 1 -> gain 2 -> bias 3 -> limit 2.5 -> nearest multiple of 0.4 is 2.4. Any other order gives another number.
  EXPECT_DOUBLE_EQ(readings(defects, constant(1.0), 1)[0].value, 2.4);
  // Noise comes before the limit: nothing gets past it.
  defects.noise.sd = 10.0;
  for (const auto& reading : readings(defects, constant(1.0), 1000, test::seed(14))) {
    ASSERT_LE(std::abs(reading.value), 2.4 + 1e-12);
  }
}

}  // namespace
}  // namespace steerid
