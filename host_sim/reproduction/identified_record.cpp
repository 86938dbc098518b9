// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/identified_record.hpp"

#include <stdexcept>

#include "app/run_loop.hpp"
#include "app/task.hpp"
#include "backend/replayed.hpp"
#include "fit/gauss_newton.hpp"
#include "plant/free_run.hpp"

namespace steerid {
namespace {

ArmAnswer answer_of(const Estimate& estimate) {
  ArmAnswer answer;
  const std::array parameters{&estimate.inertia, &estimate.damping, &estimate.stiffness};
  for (std::size_t i = 0; i < 3; ++i) {
    answer.value[i] = parameters[i]->value_micro * 1e-6;
    answer.sd[i] = parameters[i]->sd_micro * 1e-6;
    answer.state[i] = parameters[i]->state;
  }
  return answer;
}

ArmAnswer answer_of(const BatchFit& fit) {
  ArmAnswer answer;
  const std::array parameters{&fit.inertia, &fit.damping, &fit.stiffness};
  for (std::size_t i = 0; i < 3; ++i) {
    answer.value[i] = parameters[i]->value;
    answer.sd[i] = parameters[i]->sd;
    answer.state[i] = parameters[i]->state;
  }
  return answer;
}

}  // namespace

std::optional<NaturalFrequency> ArmAnswer::frequency() const {
  if (!all_valid()) return std::nullopt;
  return natural_frequency(wheel());
}

std::vector<Estimate> firmware_estimates(const Record& record) {
  ReplayedHal hal(record);
  IdentificationTask<float> task;
  if (run_loop(hal, task) != Status::kOk) throw std::logic_error("a replayed record ended otherwise than by its end");
  return hal.estimates();
}

IdentifiedRecord identify_recording(std::size_t subject, const RecordingSettings& settings, const Record& record) {
  IdentifiedRecord out;
  out.subject = subject;
  out.what = settings;
  const Estimate last = firmware_estimates(record).back();
  out.recursive = answer_of(last);
  out.driver = last.driver;
  const BatchFit fit = fit_batch(record);
  out.batch = answer_of(fit);
  out.quality = model_quality(record, fit);
  FreeRun free_run(record);
  const std::span<const double> true_run = free_run(settings.arm);
  out.true_arm_fit_percent = amplitude_fit_percent(amplitude_curves(record.angle_rad, true_run, kTickS));
  out.convergence_factor = fit.convergence_factor.value_or(0);
  out.gauss_newton_steps = fit.iterations;
  return out;
}

}  // namespace steerid
