// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Nanoseconds per sample of the identifier: the update alone, and the 100 Hz task around it (input supervision, units,
// the published estimate).
#include <benchmark/benchmark.h>

#include <vector>

#include "app/task.hpp"
#include "backend/simulated.hpp"

namespace steerid {
namespace {

/// The samples of a simulated probe drive, in the port's integers.
std::vector<Sample> samples() {
  Scenario scenario;
  scenario.task = task_settings(TaskKind::kProbe, HandPosition::kRight3, 1);
  scenario.wheel = scenario.task.arm;
  SimulatedHal hal(scenario);
  std::vector<Sample> all;
  Sample sample;
  while (hal.wait_tick() == Status::kOk) {
    if (hal.read_sample(sample) == Status::kOk) all.push_back(sample);
  }
  return all;
}

template <class Scalar>
void update(benchmark::State& state) {
  const std::vector<Sample> drive = samples();
  Identifier<Scalar> identifier;
  std::size_t i = 0;
  for (auto unused : state) {
    static_cast<void>(unused);
    const Sample& sample = drive[i];
    identifier.update(Scalar(sample.torque_driver_mnm - sample.torque_motor_mnm) * Scalar(1e-3),
                      Scalar(sample.angle_urad) * Scalar(1e-6));
    i = i + 1 == drive.size() ? 0 : i + 1;
  }
  benchmark::DoNotOptimize(identifier.value());
}

template <class Scalar>
void task_tick(benchmark::State& state) {
  const std::vector<Sample> drive = samples();
  IdentificationTask<Scalar> task;
  std::int64_t now_us = 0;
  std::size_t i = 0;
  for (auto unused : state) {
    static_cast<void>(unused);
    Sample sample = drive[i];
    sample.stamp_us = now_us += kTickPeriodUs;  // time goes on where the drive starts again
    task.take(sample);
    benchmark::DoNotOptimize(task.estimate());
    i = i + 1 == drive.size() ? 0 : i + 1;
  }
}

BENCHMARK(update<float>);
BENCHMARK(update<double>);
BENCHMARK(task_tick<float>);
BENCHMARK(task_tick<double>);

}  // namespace
}  // namespace steerid
