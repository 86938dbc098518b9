// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The whole loop as `steerid simulate` runs it: task, plant, sensors, port and the identifier in the 100 Hz task. The
// counter is simulated seconds per second of processor time: aim 50,000.
#include <benchmark/benchmark.h>

#include "app/run_loop.hpp"
#include "backend/simulated.hpp"

namespace steerid {
namespace {

template <class Scalar>
void whole_loop(benchmark::State& state, TaskKind kind) {
  constexpr double kDurationS = 600.0;
  Scenario scenario;
  scenario.task = task_settings(kind, HandPosition::kRight3, 1);
  scenario.wheel = scenario.task.arm;
  scenario.duration_s = kDurationS;
  for (auto unused : state) {
    static_cast<void>(unused);
    SimulatedHal hal(scenario);
    IdentificationTask<Scalar> task;
    benchmark::DoNotOptimize(run_loop(hal, task));
    benchmark::DoNotOptimize(task.estimate());
  }
  state.counters["simulated_s_per_s"] =
      benchmark::Counter(kDurationS * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void loop_float(benchmark::State& state, TaskKind kind) { whole_loop<float>(state, kind); }
void loop_double(benchmark::State& state, TaskKind kind) { whole_loop<double>(state, kind); }

BENCHMARK_CAPTURE(loop_float, passive, TaskKind::kPassive)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(loop_float, active, TaskKind::kActive)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(loop_float, probe, TaskKind::kProbe)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(loop_double, probe, TaskKind::kProbe)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace steerid
