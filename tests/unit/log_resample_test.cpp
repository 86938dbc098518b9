// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Oracle: sines whose amplitude and phase are known in closed form, sampled at the source's stamps and fitted, by least
// squares of this file's own, at the resampled stamps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "log/bad_input.hpp"
#include "log/record_quality.hpp"
#include "log/resample.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

using std::numbers::pi;

std::vector<double> even_stamps(double rate_hz, double duration_s) {
  std::vector<double> time_s;
  for (int i = 0; i / rate_hz <= duration_s; ++i) time_s.push_back(i / rate_hz);
  return time_s;
}

/// Even stamps each moved by up to +-share of a period. Uniform from raw bits: portable, unlike the distributions.
std::vector<double> jittered_stamps(double rate_hz, double duration_s, double share, std::uint64_t seed_value) {
  std::mt19937_64 bits(seed_value);
  std::vector<double> time_s = even_stamps(rate_hz, duration_s);
  for (double& t : time_s) t += share / rate_hz * (static_cast<double>(bits() >> 11) * 0x1p-52 - 1.0);
  return time_s;
}

/// cos(2 pi f t + 0.4) on every channel.
Record cosine(std::vector<double> time_s, double frequency_hz) {
  Record record;
  for (const double t : time_s) record.angle_rad.push_back(std::cos(2.0 * pi * frequency_hz * t + 0.4));
  record.torque_driver_nm = record.angle_rad;
  record.torque_motor_nm = record.angle_rad;
  record.time_s = std::move(time_s);
  return record;
}

/// The complex gain that took cos(2 pi f t + 0.4) to the record's angle: least squares on cosine and sine.
std::complex<double> gain(const Record& record, double frequency_hz) {
  double cc = 0.0, ss = 0.0, cs = 0.0, cy = 0.0, sy = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double phase = 2.0 * pi * frequency_hz * record.time_s[i] + 0.4;
    const double c = std::cos(phase), s = std::sin(phase), y = record.angle_rad[i];
    cc += c * c, ss += s * s, cs += c * s, cy += c * y, sy += s * y;
  }
  const double determinant = cc * ss - cs * cs;
  return {(cy * ss - sy * cs) / determinant, -(sy * cc - cy * cs) / determinant};
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double worst_error(const Record& record, double frequency_hz) {
  double worst = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    worst = std::max(worst, std::abs(record.angle_rad[i] - std::cos(2.0 * pi * frequency_hz * record.time_s[i] + 0.4)));
  }
  return worst;
}

TEST(LogResample, TreatsEveryChannelAlikeAndKeepsWhichAreThere) {
  Record record = cosine(jittered_stamps(250, 10, 0.1, seed(17)), 3);
  record.torque_bar_nm = record.angle_rad;
  record.probe_nm = record.angle_rad;
  record.channels = kAngleValid | kTorqueMotorValid | kTorqueBarValid | kProbeValid;
  const Record even = resample_100hz(record).record;
  EXPECT_EQ(even.channels, record.channels);
  EXPECT_EQ(even.torque_bar_nm, even.angle_rad);
  EXPECT_EQ(even.probe_nm, even.angle_rad);
  EXPECT_TRUE(even.torque_rim_nm.empty());
  EXPECT_EQ(even.torque_driver_nm.size(), even.size());
}

TEST(Resample, PassBandKeepsAmplitudeAndPhase) {
  // 1e-4 is the 80 dB the header promises, as ripple; the phase of a centred symmetric filter is exactly zero, and
  // 1e-6 rad at 30 Hz would be 5 ns. 1000 Hz has one phase, 1024 and 999 have many, 5000 is far.
  for (const double rate_hz : {1000.0, 1024.0, 999.0, 250.0, 5000.0}) {
    for (const double frequency_hz : {0.1, 1.0, 5.0, 12.7, 29.9}) {
      SCOPED_TRACE(testing::Message() << frequency_hz << " Hz in a record of " << rate_hz << " Hz");
      const Resampled resampled = resample_100hz(cosine(even_stamps(rate_hz, 20.0), frequency_hz));
      EXPECT_TRUE(resampled.filtered);
      EXPECT_LT(worst_error(resampled.record, frequency_hz), 1e-4);
      EXPECT_NEAR(std::abs(gain(resampled.record, frequency_hz)), 1.0, 1e-4);
      EXPECT_NEAR(std::arg(gain(resampled.record, frequency_hz)), 0.0, 1e-6);
    }
  }
}

TEST(Resample, TransitionBandFalls) {
  // Half way, at 40 Hz, a windowed sinc is at one half; it must be neither passed nor stopped.
  const Resampled resampled = resample_100hz(cosine(even_stamps(1000.0, 20.0), 40.0));
  EXPECT_NEAR(std::abs(gain(resampled.record, 40.0)), 0.5, 0.01);
}

TEST(Resample, StopBandIsEightyDecibelsDown) {
  // Whatever of these were left would appear as an alias: the rms of the whole output is what is left of 0.707.
  for (const double rate_hz : {1000.0, 1024.0, 5000.0}) {
    for (const double frequency_hz : {50.0, 51.3, 60.0, 75.0, 95.0, 99.0, 105.0, 150.5, 233.0, 400.0, 499.0}) {
      SCOPED_TRACE(testing::Message() << frequency_hz << " Hz in a record of " << rate_hz << " Hz");
      const Resampled resampled = resample_100hz(cosine(even_stamps(rate_hz, 20.0), frequency_hz));
      EXPECT_LT(rms(resampled.record.angle_rad), std::sqrt(0.5) * 1e-4);
    }
  }
}

TEST(Resample, ASlowerRecordIsFilledInBetween) {
  for (const double rate_hz : {50.0, 62.5, 80.0, 99.0}) {
    for (const double frequency_hz : {0.3, 5.0, 0.29 * rate_hz}) {
      SCOPED_TRACE(testing::Message() << frequency_hz << " Hz in a record of " << rate_hz << " Hz");
      const Resampled resampled = resample_100hz(cosine(even_stamps(rate_hz, 20.0), frequency_hz));
      EXPECT_LT(worst_error(resampled.record, frequency_hz), 1e-4);
    }
  }
}

TEST(Resample, EveryChannelPassesTheSameFilter) {
  const Resampled resampled = resample_100hz(cosine(even_stamps(1000.0, 5.0), 37.0));
  EXPECT_EQ(resampled.record.angle_rad, resampled.record.torque_driver_nm);
  EXPECT_EQ(resampled.record.angle_rad, resampled.record.torque_motor_nm);
}

TEST(Resample, EdgesShrinkByHalfTheFilter) {
  const Resampled resampled = resample_100hz(cosine(even_stamps(1000.0, 10.0), 1.0));
  const AntiAlias filter = anti_alias_for(1000.0);
  EXPECT_NEAR(filter.pass_hz, 30.0, 1e-12);
  EXPECT_NEAR(filter.stop_hz, 50.0, 1e-12);
  EXPECT_NEAR(filter.half_length_s, 0.143, 5e-4);
  EXPECT_NEAR(resampled.record.time_s.front(), 0.15, 1e-9);
  EXPECT_NEAR(resampled.record.time_s.back(), 9.85, 1e-9);
  EXPECT_EQ(resampled.record.size(), 971U);
  EXPECT_NEAR(resampled.source_rate_hz, 1000.0, 1e-6);
}

TEST(Resample, JitteredStampsAreTakenAtTheirWord) {
  const std::uint64_t seed_value = seed(7);
  // At 1 kHz the cubic's error at 29 Hz is (2 pi 29 / 1000)^4 (3/128) (1 + jitter)^4 < 6e-5, beside the filter's 1e-4.
  for (const double frequency_hz : {0.5, 5.0, 29.0}) {
    const Resampled resampled = resample_100hz(cosine(jittered_stamps(1000.0, 20.0, 0.2, seed_value), frequency_hz));
    EXPECT_TRUE(resampled.filtered);
    EXPECT_LT(worst_error(resampled.record, frequency_hz), 1.6e-4) << frequency_hz << " Hz";
    EXPECT_NEAR(std::arg(gain(resampled.record, frequency_hz)), 0.0, 2e-5) << frequency_hz << " Hz";
  }
}

TEST(Resample, AJittered100HzRecordIsPutOnTheGridUnfiltered) {
  // The grid begins at the first stamp, up to 2 ms off as any other: its points lie within 4 ms of a sample. The error
  // is at most w^4/24 times the product of the distances to the four samples, (4 ms)(14 ms)(16 ms)(26 ms) at worst,
  // which for 5 Hz is 9.5e-4.
  const Resampled resampled = resample_100hz(cosine(jittered_stamps(100.0, 60.0, 0.2, seed(8)), 5.0));
  EXPECT_FALSE(resampled.untouched);
  EXPECT_FALSE(resampled.filtered);
  EXPECT_LT(worst_error(resampled.record, 5.0), 9.5e-4);
  EXPECT_NEAR(std::arg(gain(resampled.record, 5.0)), 0.0, 2e-5);
  for (std::size_t i = 1; i < resampled.record.size(); ++i) {
    ASSERT_NEAR(resampled.record.time_s[i] - resampled.record.time_s[i - 1], 0.01, 1e-12);
  }
}

TEST(Resample, An100HzRecordPassesThroughBitForBit) {
  // Gaps too, and stamps that are rounded or off by less than 1 %.
  Record record = cosine(jittered_stamps(100.0, 20.0, 0.004, seed(9)), 3.0);
  for (std::vector<double>* column :
       {&record.time_s, &record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad}) {
    column->erase(column->begin() + 500, column->begin() + 600);
  }
  const Resampled resampled = resample_100hz(record);
  EXPECT_TRUE(resampled.untouched);
  EXPECT_EQ(resampled.record.time_s, record.time_s);
  EXPECT_EQ(resampled.record.torque_driver_nm, record.torque_driver_nm);
  EXPECT_EQ(resampled.record.torque_motor_nm, record.torque_motor_nm);
  EXPECT_EQ(resampled.record.angle_rad, record.angle_rad);
}

TEST(Resample, ASingleLostSampleIsFilledAndTheOthersKept) {
  const Record whole = cosine(even_stamps(100.0, 5.0), 2.0);
  Record holed = whole;
  for (std::vector<double>* column :
       {&holed.time_s, &holed.torque_driver_nm, &holed.torque_motor_nm, &holed.angle_rad}) {
    column->erase(column->begin() + 123);
  }
  const Resampled resampled = resample_100hz(holed);
  ASSERT_EQ(resampled.record.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    // In the middle of (2 h, h, h, 2 h) the cubic is off by 4 h^4 w^4 / 24 = 4.2e-5 at 2 Hz; elsewhere by nothing.
    if (i == 123) {
      EXPECT_NEAR(resampled.record.angle_rad[i], whole.angle_rad[i], 4.2e-5);
      EXPECT_NE(resampled.record.angle_rad[i], whole.angle_rad[i]);
    } else {
      EXPECT_EQ(resampled.record.angle_rad[i], whole.angle_rad[i]) << i;
    }
  }
}

TEST(Resample, NothingIsInventedAcrossAGap) {
  Record record = cosine(even_stamps(1000.0, 10.0), 1.0);
  for (std::vector<double>* column :
       {&record.time_s, &record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad}) {
    column->erase(column->begin() + 4001, column->begin() + 5000);  // stamps 4.001 to 4.999
  }
  const Resampled resampled = resample_100hz(record);
  EXPECT_LT(worst_error(resampled.record, 1.0), 1e-4);
  const std::vector<GapFreeRows> parts = gap_free_rows(resampled.record);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(resampled.record.time_s[parts[0].end - 1], 3.85, 1e-9);
  EXPECT_NEAR(resampled.record.time_s[parts[1].begin], 5.15, 1e-9);
}

// One sample in five lost at random leaves holes of up to 10 ms all over a fast log. They were gaps, each of which
// costs the filter's length, so that next to nothing was left.
TEST(Resample, AFastLogThatLosesSamplesAtRandomIsOneStretch) {
  for (const double rate_hz : {500.0, 1000.0}) {
    std::mt19937_64 bits(seed(21));
    std::vector<double> time_s;
    for (const double t : even_stamps(rate_hz, 10)) {
      if (time_s.empty() || bits() % 5 != 0) time_s.push_back(t);
    }
    const Resampled resampled = resample_100hz(cosine(time_s, 5));
    // Five lost in a row at 500 Hz: 1.3 times in the mean, more than six times once in 4000 seeds.
    EXPECT_LE(gap_free_rows(resampled.record).size(), 7U) << rate_hz;
    EXPECT_GT(resampled.record.size(), 780U) << rate_hz;
    EXPECT_LT(worst_error(resampled.record, 5), 5e-4) << rate_hz;
  }
}

TEST(Resample, StretchesShorterThanTheFilterAreDroppedAndCounted) {
  Record record = cosine(even_stamps(1000.0, 10.0), 1.0);
  for (std::vector<double>* column :
       {&record.time_s, &record.torque_driver_nm, &record.torque_motor_nm, &record.angle_rad}) {
    column->erase(column->begin() + 250, column->begin() + 260);  // a first stretch of 0.25 s, the filter has 0.286
  }
  const Resampled resampled = resample_100hz(record);
  EXPECT_EQ(resampled.dropped_stretches, 1U);
  EXPECT_NEAR(resampled.record.time_s.front(), 0.41, 1e-9);
}

TEST(Resample, ARecordWithoutALongEnoughStretchIsRefused) {
  try {
    (void)resample_100hz(cosine(even_stamps(1000.0, 0.2), 1.0));
    ADD_FAILURE() << "was resampled";
  } catch (const BadInput& error) {
    EXPECT_STREQ(error.what(),
                 "expected a stretch without gaps longer than the anti-alias filter's 0.29 s, found 1 shorter ones; "
                 "record without losing samples");
  }
}

}  // namespace
}  // namespace steerid::test
