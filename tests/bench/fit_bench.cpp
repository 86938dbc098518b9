// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Milliseconds for the batch fit of a 60 s record at 100 Hz: aim 5 ms.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "fit/gauss_newton.hpp"
#include "plant/linear_response.hpp"

namespace {

// A multisine drive with 0.1 degree of angle noise, 0.03 Nm of torque noise and a slow unmeasured torque.
steerid::Record noisy_record(double unmeasured_nm) {
  std::mt19937_64 random(1);
  const auto noise = [&] {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11) * 0x1p-53;
    return sum;
  };
  steerid::Record record;
  std::vector<double> applied;
  double slow = 0;
  for (int i = 0; i < 6000; ++i) {
    const double t = 0.01 * i;
    double torque = 0;
    for (int k = 1; k <= 24; ++k) torque += 0.43 * std::sin(2 * std::numbers::pi * 0.2 * k * t + 1.7 * k * k);
    slow += 0.03 * (noise() - slow);
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(torque + 0.03 * noise());
    record.torque_motor_nm.push_back(0);
    applied.push_back(torque + unmeasured_nm * 8 * slow);
  }
  const auto torque =
      steerid::TorqueSignal::from_samples(record.time_s, applied, steerid::TorqueSignal::Between::kBandLimited);
  record.angle_rad = steerid::free_run({0.11, 1.5, 22.7}, torque, record.time_s, {});
  for (double& angle : record.angle_rad) angle += 0.1 * std::numbers::pi / 180 * noise();
  return record;
}

void fit(benchmark::State& state, steerid::FitOptions::Noise noise, double unmeasured_nm) {
  const steerid::Record record = noisy_record(unmeasured_nm);
  steerid::FitOptions options;
  options.noise = noise;
  for (auto _ : state) benchmark::DoNotOptimize(steerid::fit_batch(record, options).inertia.value);
}

using Noise = steerid::FitOptions::Noise;
BENCHMARK_CAPTURE(fit, white, Noise::kWhite, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit, coloured, Noise::kAutoregressive, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit, coloured_with_unmeasured_torque, Noise::kAutoregressive, 0.15)->Unit(benchmark::kMillisecond);

}  // namespace
