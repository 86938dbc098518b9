// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Samples that a logger filled in by straight lines, and samples that only look a little like it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "log/interpolated_samples.hpp"
#include "log/resample.hpp"
#include "support/seed.hpp"

namespace steerid::test {
namespace {

/// A sine with noise at `rate_hz`, its channels rounded to `step`.
Record measured(double rate_hz, double step, double noise, std::uint64_t seed_value) {
  std::mt19937_64 bits(seed_value);
  const auto uniform = [&] { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1.0; };
  Record record;
  for (int i = 0; i < 1000; ++i) {
    const double t = i / rate_hz;
    const auto channel = [&](double phase) {
      return step * std::round((std::cos(6.283 * t + phase) + noise * uniform()) / step);
    };
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(channel(0));
    record.torque_motor_nm.push_back(0);
    record.angle_rad.push_back(channel(1));
  }
  return record;
}

/// With every - 1 rows on the straight line between two, to six digits, after `before` rows that were lost.
Record filled_in(const Record& record, std::size_t every, std::size_t before) {
  Record out;
  const auto fill = [&](const std::vector<double>& from, std::vector<double>& to) {
    for (std::size_t i = before; i < (from.size() - 1) * every; ++i) {
      const double share = static_cast<double>(i % every) / static_cast<double>(every);
      to.push_back(1e-6 * std::round(1e6 * ((1 - share) * from[i / every] + share * from[i / every + 1])));
    }
  };
  fill(record.time_s, out.time_s);
  fill(record.torque_driver_nm, out.torque_driver_nm);
  fill(record.torque_motor_nm, out.torque_motor_nm);
  fill(record.angle_rad, out.angle_rad);
  return out;
}

TEST(InterpolatedSamples, AreToldFromMeasuredOnes) {
  for (const double step : {1e-6, 5e-3}) {
    for (const std::size_t every : {2U, 5U, 20U}) {
      for (const std::size_t before : {0U, 1U}) {
        const Record record = filled_in(measured(100, step, 0.01, seed(71)), every, before);
        const MeasuredRows rows = measured_rows(record);
        EXPECT_EQ(rows.every, every) << step << " " << before;
        EXPECT_EQ(rows.first, before == 0 ? 0 : every - 1) << step;
      }
    }
  }
}

TEST(InterpolatedSamples, WhatWasMeasuredComesBack) {
  const Record record = measured(100, 5e-3, 0.01, seed(72));
  const Resampled resampled = resample_100hz(filled_in(record, 5, 0));
  EXPECT_TRUE(resampled.filled_in);
  ASSERT_EQ(resampled.record.size(), record.size() - 1);
  for (std::size_t i = 0; i < resampled.record.size(); ++i) {
    ASSERT_NEAR(resampled.record.angle_rad[i], record.angle_rad[i], 1e-6);
  }
}

TEST(InterpolatedSamples, NoneAreFoundWhereAllWereMeasured) {
  const auto all = [](const Record& record) { return measured_rows(record).every == 1; };
  EXPECT_TRUE(all(measured(100, 1e-6, 0.01, seed(73))));
  EXPECT_TRUE(all(measured(1000, 5e-3, 0, seed(73))));  // coarse: most rows repeat the one before
  EXPECT_TRUE(all(measured(1000, 1e-6, 0, seed(73))));  // smooth
  Record one = filled_in(measured(100, 1e-6, 0.01, seed(74)), 5, 0);
  one.angle_rad = measured(500, 1e-6, 0.01, seed(74)).angle_rad;
  one.angle_rad.resize(one.size(), 0.0);
  EXPECT_TRUE(all(one)) << "one channel of two";
  Record held = measured(500, 1e-6, 0.01, seed(75));  // repeated, as by a hold: no straight lines between
  for (std::size_t i = 0; i < held.size(); ++i) {
    held.angle_rad[i] = held.angle_rad[i - i % 5];
    held.torque_driver_nm[i] = held.torque_driver_nm[i - i % 5];
  }
  EXPECT_TRUE(all(held));
}

TEST(InterpolatedSamples, TooSlowARecordStaysAsItIs) {
  EXPECT_FALSE(resample_100hz(filled_in(measured(20, 1e-6, 0.01, seed(76)), 5, 0)).filled_in);
}

}  // namespace
}  // namespace steerid::test
