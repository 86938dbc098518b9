// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fit/amplitude_fit.hpp"

namespace {

std::vector<double> sine(double amplitude, double frequency_hz, std::size_t samples, double mean = 0) {
  std::vector<double> out;
  for (std::size_t i = 0; i < samples; ++i) {
    out.push_back(mean + amplitude * std::sin(2 * std::numbers::pi * frequency_hz * 0.01 * static_cast<double>(i)));
  }
  return out;
}

TEST(AmplitudeFit, IsTheAmplitudesShare) {
  const std::vector<double> measured = sine(1.0, 1.25, 2048, 3);
  const steerid::AmplitudeCurves curves = steerid::amplitude_curves(measured, sine(0.9, 1.25, 2048), 0.01);
  EXPECT_NEAR(*steerid::amplitude_fit_percent(curves), 90, 1e-6);
  const std::size_t peak = static_cast<std::size_t>(
      std::max_element(curves.measured_rad.begin(), curves.measured_rad.end()) - curves.measured_rad.begin());
  EXPECT_NEAR(curves.frequency_hz[peak], 1.25, 0.05);  // one bin is 0.049 Hz
  EXPECT_NEAR(curves.measured_rad[peak], 1.0, 0.15);   // a line between two bins loses up to 15 % to Hann
  EXPECT_LE(curves.frequency_hz.back(), 5.0);
  EXPECT_GT(curves.frequency_hz.back(), 4.9);
}

TEST(AmplitudeFit, IgnoresWhatLiesAboveFiveHertz) {
  std::vector<double> measured = sine(1.0, 1.25, 4096);
  const std::vector<double> model = measured;
  const std::vector<double> high = sine(0.5, 20, 4096);
  for (std::size_t i = 0; i < measured.size(); ++i) measured[i] += high[i];
  EXPECT_NEAR(*steerid::amplitude_fit_percent(steerid::amplitude_curves(measured, model, 0.01)), 100, 0.01);
}

TEST(AmplitudeFit, AnswersNothingForNothing) {
  EXPECT_FALSE(steerid::amplitude_fit_percent(steerid::amplitude_curves({}, {}, 0.01)));
  const std::vector<double> still(100, 2.0);
  EXPECT_FALSE(steerid::amplitude_fit_percent(steerid::amplitude_curves(still, still, 0.01)));
  EXPECT_FALSE(steerid::free_run_nrmse(still, still));
}

TEST(FreeRunNrmse, IsRmsOverStandardDeviation) {
  const std::vector<double> measured = sine(2.0, 1, 1000, 5);
  EXPECT_NEAR(*steerid::free_run_nrmse(measured, std::vector<double>(1000, 5.0)), 1, 1e-12);
  EXPECT_NEAR(*steerid::free_run_nrmse(measured, sine(1.9, 1, 1000, 5)), 0.05, 1e-12);
  std::vector<double> model = sine(1.9, 1, 1000, 5);
  model[3] = std::nan("");  // not used by the fit
  EXPECT_NEAR(*steerid::free_run_nrmse(measured, model), 0.05, 1e-4);
}

}  // namespace
