// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/answers.hpp"

#include <limits>
#include <utility>

namespace steerid {
namespace {

IdentifiedParameter from_fit(const FittedParameter& fitted) {
  return {fitted.value, fitted.sd, fitted.state, fitted.at_most};
}

/// Completes `found` by how well the free run of `fit` explains the record.
Answer judged(Identification found, const Record& record, const BatchFit& fit) {
  Answer answer{std::move(found), fit.angle_model_rad, {}};
  if (fit.stop == StopReason::kNoData) return answer;
  ModelQuality quality = model_quality(record, fit);
  answer.found.amplitude_fit_percent = quality.amplitude_fit_percent;
  answer.found.free_run_nrmse = quality.free_run_nrmse;
  answer.curves = std::move(quality.curves);
  return answer;
}

}  // namespace

Answer recursive_answer(const Record& record, const FirmwareRun& run, bool torque_offset) {
  Identification found;
  found.method = "recursive";
  found.equation = record.equation();
  if (record.has(kTorqueBarValid) && record.has(kTorqueRimValid)) found.wheel = wheel_between(record);
  if (run.estimates.empty()) return {found, {}, {}};
  const Estimate& last = run.estimates.back();
  const double unit = run.units.parameter();
  found.inertia_kgm2 = from_published(last.inertia, unit);
  found.damping_nms_per_rad = from_published(last.damping, unit);
  found.stiffness_nm_per_rad = from_published(last.stiffness, unit);
  if (!(found.inertia_kgm2.value > 0.0)) return {found, {}, {}};

  // No step is taken: the fit only finds the initial states that J, B and C need for a free run.
  FitOptions free_run;
  free_run.start =
      WheelArm{found.inertia_kgm2.value, found.damping_nms_per_rad.value, found.stiffness_nm_per_rad.value};
  free_run.max_iterations = 0;
  free_run.noise = FitOptions::Noise::kWhite;
  free_run.torque_offset = torque_offset;
  free_run.convergence_factor = false;
  return judged(std::move(found), record, fit_batch(record, free_run));
}

void disbelieve(Identification& found, const std::string& doubt) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  found.doubt = doubt;
  found.inertia_kgm2 = found.damping_nms_per_rad =
      found.stiffness_nm_per_rad = {.value = kNone, .state = ParameterState::kFault};
}

BatchAnswer batch_answer(const Record& record, bool torque_offset) {
  FitOptions options;
  options.torque_offset = torque_offset;
  options.inertia_limit = true;
  BatchFit fit = fit_batch(record, options);
  Identification found;
  found.method = "batch_gauss_newton";
  found.equation = record.equation();
  found.inertia_kgm2 = from_fit(fit.inertia);
  found.damping_nms_per_rad = from_fit(fit.damping);
  found.stiffness_nm_per_rad = from_fit(fit.stiffness);
  Answer answer = judged(std::move(found), record, fit);
  return {std::move(answer), std::move(fit)};
}

}  // namespace steerid
