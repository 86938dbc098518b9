// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/diagnosis/predicted_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fit/amplitude_fit.hpp"
#include "fit/gauss_newton.hpp"
#include "gap/likelihood/noise_floor.hpp"
#include "gap/preparation/record_gates.hpp"
#include "log/bad_input.hpp"
#include "log/resample.hpp"
#include "plant/effects/vocabulary.hpp"
#include "sensors/random.hpp"

namespace steerid::gap {
namespace {

BadInput unlike_a_wheel(const std::string& why) {
  return BadInput(why + "; check the prediction's sign, its unit and its clock");
}

/// A third of the record's own noise on its angle: see the header.
void add_noise(Record& prediction, const Resampled& measured, std::uint64_t seed) {
  constexpr double kShare = 1.0 / 3;
  const double pass_hz = measured.filtered ? anti_alias_for(measured.source_rate_hz).pass_hz : kAllPassed_hz;
  const double sd = kShare * std::sqrt(white_noise_variance(measured.record.angle_rad, measured.record, pass_hz));
  Random random(seed);
  for (double& angle : prediction.angle_rad) angle += sd * random.normal();
}

/// Never less than what a simulation may be.
Simulation nearest_linear(const Record& prediction) {
  constexpr double kLightest_kgm2 = 1e-9;
  FitOptions options;
  options.convergence_factor = false;
  const WheelArm fitted = fit_batch(prediction, options).wheel();
  Simulation simulation;
  simulation.wheel = {std::max(fitted.inertia_kgm2, kLightest_kgm2), std::max(fitted.damping_nms_per_rad, 0.0),
                      std::max(fitted.stiffness_nm_per_rad, 0.0)};
  return simulation;
}

/// Nothing where the simulation is nearer to the record than the prediction is: then the prediction has something of
/// its own, such as a drift of its integrator, that neither the wheel nor the library has. Where the simulation has no
/// run, such as in gaps, nothing is said.
PredictionRemainder remainder_of(const Record& prediction, const Record& measured, const GapSeries& run) {
  const std::vector<double> predicted_rad = angles_at(run.time_s, prediction.time_s, prediction.angle_rad);
  const std::vector<double> measured_rad = angles_at(run.time_s, measured.time_s, measured.angle_rad);
  PredictionRemainder out;
  double by_prediction = 0;
  double by_simulation = 0;
  for (std::size_t i = 0; i < run.time_s.size(); ++i) {
    const double run_rad = run.with_effect_rad[i];
    if (!std::isfinite(run_rad)) continue;
    out.time_s.push_back(run.time_s[i]);
    out.angle_rad.push_back(predicted_rad[i] - run_rad);
    by_prediction += std::pow(measured_rad[i] - predicted_rad[i], 2);
    by_simulation += std::pow(measured_rad[i] - run_rad, 2);
  }
  return by_prediction < by_simulation ? out : PredictionRemainder();
}

}  // namespace

PredictedSimulation predicted_simulation(const Record& record, const std::vector<double>& predicted_rad,
                                         const DiagnoseOptions& options) {
  Record prediction = record;
  prediction.angle_rad = predicted_rad;
  prediction = resample_100hz(prediction).record;
  const Record formula = prediction;
  const Resampled measured = resample_100hz(record);
  add_noise(prediction, measured, options.seed);
  PredictedSimulation out;
  DiagnoseOptions with_origin = options;
  with_origin.origin_s = record.time_s.front();  // the filter took the prediction's beginning
  // A prediction follows from the record's torques; what it has besides is its remainder.
  with_origin.without.emplace_back(effect::unmeasured_torque.id);
  try {
    out.found = diagnose(prediction, nearest_linear(prediction), with_origin);
  } catch (const BadInput& error) {
    throw unlike_a_wheel(fmt::format("what the prediction's simulation has in it cannot be told: {}", error.what()));
  }
  out.simulation = out.found.with_effect;
  out.prediction_nrmse = free_run_nrmse(record.angle_rad, predicted_rad).value_or(1);
  out.missed_nrmse = free_run_nrmse(out.found.series.measured_rad, out.found.series.with_effect_rad).value_or(1);
  if (misses_most(out.missed_nrmse)) {
    throw unlike_a_wheel(fmt::format(
        "no simulated wheel moves as the prediction does under the record's torques: the nearest misses it by "
        "{:.0f} %",
        100 * out.missed_nrmse));
  }
  out.remainder = remainder_of(formula, measured.record, out.found.series);
  return out;
}

}  // namespace steerid::gap
