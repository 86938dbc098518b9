// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Where a gap lies, on residuals whose place is known because they were put there.
#include "gap/diagnosis/gap_axes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace steerid::gap {
namespace {

constexpr int kSamples = 6000;

/// A wheel that swings by 0.2 rad at 0.31 Hz for a minute, and what the refit leaves of it.
struct Scene {
  Record record;
  MeasuredMotion motion;
  GapSeries series;
  ResidualSpectrum spectrum;

  explicit Scene(const std::function<double(double time, double angle, double rate)>& residual_nm) {
    for (int i = 0; i < kSamples; ++i) {
      const double t = 0.01 * i;
      const double w = 2 * std::numbers::pi * 0.31;
      record.time_s.push_back(t);
      record.torque_driver_nm.push_back(4 * std::sin(w * t + 0.3));
      record.torque_motor_nm.push_back(0);
      record.angle_rad.push_back(0.2 * std::sin(w * t));
      motion.time_s.push_back(t);
      motion.angle_rad.push_back(record.angle_rad.back());
      motion.rate_rad_s.push_back(0.2 * w * std::cos(w * t));
      motion.acceleration_rad_s2.push_back(-w * w * record.angle_rad.back());
      series.torque_residual_nm.push_back(residual_nm(t, motion.angle_rad.back(), motion.rate_rad_s.back()));
    }
    for (int k = 1; k < 200; ++k) {
      spectrum.frequency_hz.push_back(0.1 * k);
      spectrum.measured_rad2_per_hz.push_back(k == 3 ? 1.0 : 1e-9);
      spectrum.refit_rad2_per_hz.push_back(k == 3 ? 1e-2 : 1e-11);
      spectrum.with_effect_rad2_per_hz.push_back(1e-12);
      spectrum.noise_rad2_per_hz.push_back(1e-12);
    }
  }

  [[nodiscard]] std::vector<GapAxis> axes() const { return gap_axes(record, motion, series, spectrum, 1e-6); }
};

const GapAxis& axis_of(const std::vector<GapAxis>& axes, std::string_view name) {
  return *std::ranges::find(axes, name, &GapAxis::axis);
}

TEST(GapAxes, SharesOfEveryAxisSumToOne) {
  const Scene scene([](double t, double, double rate) { return 0.1 * rate + 0.01 * std::sin(70 * t); });
  for (const GapAxis& axis : scene.axes()) {
    double sum = 0;
    for (const GapBin& bin : axis.bins) sum += bin.share.value;
    EXPECT_NEAR(sum, 1.0, 1e-9) << axis.axis;
    EXPECT_GE(axis.concentration, 0) << axis.axis;
    EXPECT_LE(axis.concentration, 1) << axis.axis;
  }
}

TEST(GapAxes, ATorqueAtOneEndOfTheTravelLiesAlongThePosition) {
  const Scene scene([](double, double angle, double) { return angle > 0.17 ? 0.5 : 0.0; });
  const std::vector<GapAxis> axes = scene.axes();
  EXPECT_EQ(axes.front().axis, "position");
  // The angle is above 0.85 of its peak for acos(0.85)/pi of the time, of which the last of eight bins has an eighth.
  const double expected = 0.125 / (std::acos(0.85) / std::numbers::pi);
  EXPECT_NEAR(axes.front().bins.back().share.value, expected, 0.03);
}

TEST(GapAxes, AGapThatMovesAsTheWheelDoesIsNotPlacedByFrequency) {
  // The whole of it lies at the one frequency at which the wheel moves: that says nothing.
  const Scene scene([](double, double, double rate) { return rate > 0 ? 0.3 : -0.3; });
  const std::vector<GapAxis> axes = scene.axes();
  EXPECT_NE(axes.front().axis, "frequency");
  EXPECT_LT(axis_of(axes, "frequency").concentration, 0.1);
}

TEST(GapAxes, ALineWhereTheWheelHardlyMovesIsPlacedByFrequency) {
  Scene scene([](double, double, double) { return 0.1; });
  scene.spectrum.refit_rad2_per_hz[2] = 1e-12;
  scene.spectrum.refit_rad2_per_hz[39] = 1e-3;  // 4 Hz
  const std::vector<GapAxis> axes = scene.axes();
  EXPECT_EQ(axes.front().axis, "frequency");
  EXPECT_NEAR(axes.front().bins[5].share.value, 1.0, 1e-6);  // 3 to 5 Hz
}

}  // namespace
}  // namespace steerid::gap
