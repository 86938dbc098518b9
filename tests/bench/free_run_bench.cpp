// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Free runs of a 100 s record at 100 Hz, as a fit by output error repeats them: every effect of the vocabulary at its
// presets, on the average arm, and some of those that make a wheel fast.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "plant/effects/vocabulary.hpp"
#include "plant/free_run.hpp"

namespace steerid {
namespace {

/// A slow triangle's fundamental and a multisine between 0.2 and 5 Hz.
Record drive() {
  Record record;
  for (int i = 0; i < 10'000; ++i) {
    const double t = 0.01 * i;
    double motor_nm = 4.0 * std::sin(2 * std::numbers::pi * 0.025 * t);
    for (int k = 1; k <= 24; ++k) motor_nm += 0.3 * std::sin(2 * std::numbers::pi * 0.2 * k * t + 1.7 * k * k);
    record.time_s.push_back(t);
    record.torque_driver_nm.push_back(0);
    record.torque_motor_nm.push_back(motor_nm);
    record.angle_rad.push_back(0);
  }
  return record;
}

void run(benchmark::State& state, const std::vector<Effect>& effects) {
  const Record record = drive();
  FreeRun free_run(record);
  for (auto unused : state) {
    static_cast<void>(unused);
    benchmark::DoNotOptimize(free_run({}, effects, WheelState{}).data());
  }
}

const bool kRegistered = [] {
  benchmark::RegisterBenchmark("free_run/linear", run, std::vector<Effect>{})->Unit(benchmark::kMillisecond);
  for (const EffectType* type : effects()) {
    benchmark::RegisterBenchmark(("free_run/" + std::string(type->id)).c_str(), run, std::vector<Effect>{Effect(*type)})
        ->Unit(benchmark::kMillisecond);
  }
  Effect bristles(effect::coulomb_friction);
  bristles.at("bristle_rad") = 4e-4;
  const auto beside = [](const Effect& one, const EffectType& other) {
    return std::vector<Effect>{one, Effect(other)};
  };
  const std::vector<std::pair<const char*, std::vector<Effect>>> more = {
      {"friction_with_bristles", {bristles}},
      {"friction_with_bristles_beside_compliance", beside(bristles, effect::compliance)},
      {"presliding_hysteresis_beside_compliance", beside(Effect(effect::presliding_hysteresis), effect::compliance)},
      {"friction_with_bristles_beside_ripple", beside(bristles, effect::torque_ripple)}};
  for (const auto& [name, effects] : more) {
    benchmark::RegisterBenchmark((std::string("free_run/") + name).c_str(), run, effects)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace steerid
