// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Stamps that stray, on samples that do and samples that do not. Oracle: sines in closed form.
#include <gtest/gtest.h>

#include <cmath>
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

bool even(const Record& record, double rate_hz) {
  const std::vector<std::vector<double>> channels = {record.torque_driver_nm, record.torque_motor_nm, record.angle_rad};
  return evenly_sampled(record.time_s, 1 / rate_hz, channels);
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
  const std::vector<double> stamps = even_stamps(record.time_s, 0.01);
  EXPECT_NEAR(stamps[999], 9.99, 1e-9);
  EXPECT_NEAR(stamps[1000], 10.01, 1e-9);
}

}  // namespace
}  // namespace steerid::test
