// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "apps/answers.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "fit/probe_misfit.hpp"

namespace steerid {
namespace {

IdentifiedParameter from_fit(const FittedParameter& fitted) {
  return {fitted.value, fitted.sd, fitted.state, fitted.at_most};
}

/// Completes `found` by how well its arm explains what the probe has driven.
Answer judged(Identification found, const InstrumentalFit& fit) {
  const WheelArm arm{found.inertia_kgm2.value, found.damping_nms_per_rad.value, found.stiffness_nm_per_rad.value};
  const bool known = is_identified(found.inertia_kgm2.state) && is_identified(found.damping_nms_per_rad.state) &&
                     is_identified(found.stiffness_nm_per_rad.state);
  if (known) found.driven = driven_part(fit, arm);
  // Without a probe what is unexplained is what the torque itself could not take for an arm.
  if (drives(probe_misfit(fit))) found.unmeasured_torque_nm = fit.unexplained_nm;
  return {std::move(found), {}, {}};
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
  if (!voluntary_torque_known(found.equation)) return judged(std::move(found), fit_by_instrument(record));

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

void refuse(Identification& found, const std::string& doubt) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  found.doubt = doubt;
  found.inertia_kgm2 = found.damping_nms_per_rad =
      found.stiffness_nm_per_rad = {.value = kNone, .state = ParameterState::kFault};
}

void widen(IdentifiedParameter& parameter, double by, ParameterState otherwise) {
  parameter.sd = std::hypot(parameter.sd, by);
  const bool known = parameter.sd <= FitOptions{}.valid_relative_sd * std::abs(parameter.value);
  if (parameter.state == ParameterState::kValid && !known) parameter.state = otherwise;
}

void widen(Identification& found, const ModelCheck& check) {
  const auto& by = check.torque_noise_bias;
  widen(found.inertia_kgm2, by[0], ParameterState::kNotExcited);
  widen(found.damping_nms_per_rad, by[1], ParameterState::kNotExcited);
  widen(found.stiffness_nm_per_rad, by[2], ParameterState::kNotExcited);
}

Answer batch_answer(const Record& record, bool torque_offset, const std::optional<BareWheelFit>& bare) {
  Identification found;
  found.equation = record.equation();
  const auto fill = [&](const auto& fit) {
    found.inertia_kgm2 = from_fit(fit.inertia);
    found.damping_nms_per_rad = from_fit(fit.damping);
    found.stiffness_nm_per_rad = from_fit(fit.stiffness);
  };
  if (!voluntary_torque_known(found.equation)) {
    const InstrumentalFit fit = bare ? bare->wheel : fit_by_instrument(record);
    if (bare) found.friction_nm = bare->friction;
    found.method = fit.by_probe ? "batch_instrumental_variables" : "batch_by_torque_alone";
    fill(fit);
    return judged(std::move(found), fit);
  }
  FitOptions options;
  options.torque_offset = torque_offset;
  options.inertia_limit = true;
  const BatchFit fit = fit_batch(record, options);
  found.method = "batch_gauss_newton";
  fill(fit);
  return judged(std::move(found), record, fit);
}

}  // namespace steerid
