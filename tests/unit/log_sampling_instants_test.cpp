// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Stamps that stray, on samples that do and samples that do not. Oracle: sines in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include "log/resample.hpp"
#include "log/sampling_instants.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

struct Stray {
  double rate_hz = 100;
  double share = 0.2;  ///< of a period, uniform to either side
  bool samples_too = false;
  double noise = 0.01;  ///< of the channels' rms, white
  double sample_hz = 2;
  double duration_s = 30;
};

Record strayed(const Stray& what, std::uint64_t seed_value) {
  std::mt19937_64 bits(seed_value);
  const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1.0; };
  Record record;
  for (int i = 0; i < what.rate_hz * what.duration_s; ++i) {
    const double even_s = i / what.rate_hz;
    const double stamp_s = i == 0 ? 0 : even_s + what.share / what.rate_hz * uniform();
    const double t = what.samples_too ? stamp_s : even_s;
    const auto at = [&](double phase) {
      return std::cos(6.283 * what.sample_hz * t + phase) + std::sqrt(1.5) * what.noise * uniform();
    };
    record.time_s.push_back(stamp_s);
    record.torque_driver_nm.push_back(at(0.4));
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(0.2 * at(1.0));
  }
  return record;
}

std::vector<std::vector<double>> channels_of(const Record& record) {
  return {record.torque_driver_nm, record.torque_motor_nm, record.angle_rad};
}

bool even(const Record& record, double rate_hz) {
  return evenly_sampled(record.time_s, 1 / rate_hz, channels_of(record));
}

TEST(SamplingInstants, TheSamplesTellWhoStrays) {
  for (const double rate_hz : {50.0, 100.0, 1000.0}) {
    for (const double share : {0.02, 0.2, 0.4}) {
      Stray what{.rate_hz = rate_hz, .share = share};
      // A stray moves a sample by 2 pi f times itself: little at 1 kHz, and no more than the noise may hide.
      what.noise = 0.3 * share * 6.283 * what.sample_hz / rate_hz;
      EXPECT_TRUE(even(strayed(what, seed(61)), rate_hz)) << rate_hz << " " << share;
      what.samples_too = true;
      EXPECT_FALSE(even(strayed(what, seed(61)), rate_hz)) << rate_hz << " " << share;
    }
  }
}

TEST(SamplingInstants, WhereNothingTellsTheStampsCount) {
  // With so much noise s would be known to 0.3 only; the strays move a sample by 2.5 % of its rms.
  EXPECT_FALSE(even(strayed({.noise = 0.5}, seed(62)), 100));
  Record still = strayed({}, seed(62));
  for (auto* channel : {&still.torque_driver_nm, &still.angle_rad}) channel->assign(still.size(), 1.0);
  EXPECT_FALSE(even(still, 100));
  EXPECT_FALSE(even(strayed({.duration_s = 0.9}, seed(62)), 100));
  EXPECT_FALSE(even(strayed({.share = 0.001}, seed(62)), 100));
  // A clock that wanders by a tenth of a period within a second strays, and no sample says so.
  Record wander = strayed({.share = 0}, seed(62));
  for (double& t : wander.time_s) t += 0.001 * std::sin(6.283 * t);
  EXPECT_FALSE(even(wander, 100));
}

TEST(SamplingInstants, EvenSamplesPassBitForBitWhateverTheirStamps) {
  const Record record = strayed({}, seed(63));
  const Resampled resampled = resample_100hz(record);
  EXPECT_TRUE(resampled.restamped);
  // The period is the mean of all intervals; two strays of the ends are 4e-5 s over 30 s.
  ASSERT_EQ(resampled.record.size(), record.size());
  EXPECT_EQ(resampled.record.angle_rad, record.angle_rad);
  for (std::size_t i = 0; i < record.size(); ++i) {
    EXPECT_NEAR(resampled.record.time_s[i], 0.01 * static_cast<double>(i), 0.0021);
  }
  Stray true_stray;
  true_stray.samples_too = true;
  EXPECT_FALSE(resample_100hz(strayed(true_stray, seed(63))).restamped);
}

TEST(SamplingInstants, ALostSampleLeavesItsPlaceEmpty) {
  Record record = strayed({}, seed(64));
  for (auto* column : {&record.time_s, &record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad}) {
    column->erase(column->begin() + 1000);
  }
  EXPECT_TRUE(even(record, 100));
  const std::vector<double> stamps = even_stamps(record.time_s, 0.01, channels_of(record));
  EXPECT_NEAR(stamps[999], 9.99, 1e-9);
  EXPECT_NEAR(stamps[1000], 10.01, 1e-9);
}

/// Samples of a clock of 2 ms, stamped when a logger gets round to it: one stall in fifty samples lasts up to `longest`
/// periods, and what waited is stamped at once. `lost`: every so many samples one is.
Record stamped_on_arrival(double longest, std::size_t lost, std::uint64_t seed_value) {
  std::mt19937_64 bits(seed_value);
  const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  Record record;
  double free_s = 0;
  for (std::size_t i = 0; i < 10000; ++i) {
    const double even_s = 0.002 * static_cast<double>(i);
    if (uniform() < 0.02) free_s = even_s + 0.002 * longest * uniform();
    const double noise = uniform() - 0.5;
    if (lost != 0 && i % lost == lost / 2) continue;
    record.time_s.push_back(record.size() == 0 ? even_s : std::max(even_s, free_s) + 1e-6 * static_cast<double>(i % 7));
    free_s = record.time_s.back() + 8e-6;
    record.torque_driver_nm.push_back(std::cos(12.566 * even_s) + 0.01 * noise);
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(0.2 * std::cos(12.566 * even_s + 1));
  }
  return record;
}

TEST(SamplingInstants, NoTwoSamplesShareAPlaceHoweverLateTheyAreStamped) {
  for (const double longest : {2.0, 6.0}) {
    const Record record = stamped_on_arrival(longest, 0, seed(65));
    const std::vector<double> stamps = even_stamps(record.time_s, 0.002, channels_of(record));
    for (std::size_t i = 0; i < stamps.size(); ++i) ASSERT_NEAR(stamps[i], 0.002 * static_cast<double>(i), 1e-9);
  }
}

TEST(SamplingInstants, WhatWasLostIsPartedFromWhatCameLate) {
  constexpr std::size_t kLostEvery = 400;
  const Record record = stamped_on_arrival(3, kLostEvery, seed(66));
  const std::vector<double> stamps = even_stamps(record.time_s, 0.002, channels_of(record));
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const std::size_t lost = (i + kLostEvery / 2 - 1) / (kLostEvery - 1);
    ASSERT_NEAR(stamps[i], 0.002 * static_cast<double>(i + lost), 2 * 0.0021);
  }
  // 25 were lost. One in fifty samples begins a stall of up to three, which hides a loss: two in the mean at most.
  const double places = std::round(stamps.back() / 0.002);
  EXPECT_LE(places, 9999);
  EXPECT_GE(places, 9999 - 4);
}

TEST(SamplingInstants, TheClocksPeriodIsFoundWhateverIsLateOrLost) {
  for (const std::size_t lost : {0U, 400U, 40U}) {
    const Record record = stamped_on_arrival(4, lost, seed(67));
    // Two strays of up to 8 ms at the ends of spans of 8 s, were they in the median.
    EXPECT_NEAR(clock_period_s(record.time_s, 0.0021), 0.002, 0.002 * 2e-3 / 2) << lost;
  }
}

/// Every sample of `even` late by itself, and stamped no earlier than the one before.
Record each_late(Record even, const std::function<double()>& late_s) {
  double before_s = 0;
  for (double& stamp_s : even.time_s) before_s = stamp_s = std::max(stamp_s + late_s(), before_s + 1e-5);
  return even;
}

/// As a bus with other traffic has it. The record must not become shorter: a period that is a tenth too short makes an
/// inertia a fifth too small.
TEST(SamplingInstants, ARecordKeepsItsLengthHoweverItsStampsAreLate) {
  std::mt19937_64 bits(seed(69));
  std::exponential_distribution<double> exponential(1 / 0.003);
  std::uniform_real_distribution<double> uniform;
  const Record even = strayed({.share = 0, .duration_s = 100}, seed(69));
  const auto seldom = [&] { return uniform(bits) < 0.05 ? 0.03 * uniform(bits) : 0.0; };
  for (const auto& late_s : std::vector<std::function<double()>>{[&] { return exponential(bits); }, seldom}) {
    const Record arrived = each_late(even, late_s);
    const Resampled resampled = resample_100hz(arrived);
    EXPECT_TRUE(resampled.restamped);
    EXPECT_NEAR(resampled.record.time_s.back() - resampled.record.time_s.front(), 99.99, 0.02);
  }
}

/// A logger that leaves rows out and stamps the others rightly: no sample has another place than its stamp says.
TEST(SamplingInstants, RowsThatAreMissingMoveNoOther) {
  std::mt19937_64 bits(seed(70));
  std::uniform_real_distribution<double> uniform;
  for (const double share : {0.01, 0.05, 0.2}) {
    Record record = strayed({.share = 0}, seed(70));
    for (std::size_t i = record.size() - 2; i > 1; --i) {
      if (uniform(bits) >= share) continue;
      for (auto* column : {&record.time_s, &record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad}) {
        column->erase(column->begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
    const std::vector<double> stamps = even_stamps(record.time_s, 0.01, channels_of(record));
    for (std::size_t i = 0; i < stamps.size(); ++i) ASSERT_NEAR(stamps[i], record.time_s[i], 1e-6) << share;
    EXPECT_FALSE(resample_100hz(record).restamped) << share;
  }
}

/// Samples that were taken when their stamps say, up to 45 % of a period early or late.
TEST(SamplingInstants, StampsThatAreRightCountHoweverTheyStray) {
  for (const double rate_hz : {100.0, 200.0}) {
    const Record record =
        strayed({.rate_hz = rate_hz, .share = 0.45, .samples_too = true, .duration_s = 100}, seed(71));
    const Resampled resampled = resample_100hz(record);
    EXPECT_FALSE(resampled.restamped) << rate_hz;
    EXPECT_NEAR(resampled.record.time_s.back() - resampled.record.time_s.front(), 100, 0.4) << rate_hz;
  }
}

// Of lost samples that the stamps' jitter hides the grid knows nothing: it falls behind by 80 periods within a minute.
TEST(SamplingInstants, StampsThatAreRightCountWhereSamplesAreLost) {
  std::mt19937_64 bits(seed(66));
  for (const double share : {0.2, 0.3}) {
    for (const std::uint64_t one_in : {50U, 10U, 5U}) {
      const Record all =
          strayed({.share = share, .samples_too = true, .noise = 0.002, .duration_s = 60}, seed(66) + one_in);
      Record some;
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (bits() % one_in == 0) continue;
        some.time_s.push_back(all.time_s[i]);
        some.torque_driver_nm.push_back(all.torque_driver_nm[i]);
        some.torque_motor_nm.push_back(0);
        some.angle_rad.push_back(all.angle_rad[i]);
      }
      EXPECT_FALSE(even(some, 100)) << share << " one in " << one_in;
      EXPECT_FALSE(resample_100hz(some).restamped) << share << " one in " << one_in;
    }
  }
}

TEST(SamplingInstants, LateStampsComeOutAsTheSineThatWasSampled) {
  const Record record = stamped_on_arrival(6, 500, seed(68));
  const Resampled resampled = resample_100hz(record);
  EXPECT_TRUE(resampled.restamped);
  EXPECT_LE(resampled.dropped_stretches, 1U);  // what the record's last stall held may pass for late by a loss
  ASSERT_GT(resampled.record.size(), 1900U);
  for (std::size_t i = 0; i < resampled.record.size(); ++i) {
    // Three places of 2 ms wrong are 0.015 rad: of 60 seeds about half have a sample two places wrong, five one of
    // three.
    ASSERT_NEAR(resampled.record.angle_rad[i], 0.2 * std::cos(12.566 * resampled.record.time_s[i] + 1), 0.0155);
  }
}

}  // namespace
}  // namespace steerid::test
