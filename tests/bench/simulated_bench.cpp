// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The simulated back end alone: task, linear wheel and sensors, without an identifier. The counter is simulated seconds
// per second of processor time.
#include <benchmark/benchmark.h>

#include "backend/simulated.hpp"

namespace steerid {
namespace {

void simulate(benchmark::State& state, TaskKind kind, const SensorDefects& sensors) {
  Scenario scenario;
  scenario.task = task_settings(kind, HandPosition::kRight3, 1);
  scenario.wheel = scenario.task.arm;
  scenario.sensors = sensors;
  scenario.duration_s = 86'400.0 * 365.0;
  SimulatedHal hal(scenario);
  Sample sample;
  for (auto unused : state) {
    static_cast<void>(unused);
    benchmark::DoNotOptimize(hal.wait_tick());
    benchmark::DoNotOptimize(hal.read_sample(sample));
  }
  state.counters["simulated_s_per_s"] =
      benchmark::Counter(kTickS * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(simulate, passive, TaskKind::kPassive, SensorDefects::realistic());
BENCHMARK_CAPTURE(simulate, active, TaskKind::kActive, SensorDefects::realistic());
BENCHMARK_CAPTURE(simulate, probe, TaskKind::kProbe, SensorDefects::realistic());
BENCHMARK_CAPTURE(simulate, probe_perfect_sensors, TaskKind::kProbe, SensorDefects::none());

}  // namespace
}  // namespace steerid
