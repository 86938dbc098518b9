// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/arm_score.hpp"

#include <algorithm>
#include <cmath>

#include "experiment/signal_point.hpp"

namespace steerid {

ParameterTicks& ParameterTicks::operator+=(const ParameterTicks& other) {
  ticks += other.ticks;
  valid += other.valid;
  valid_close += other.valid_close;
  outside += other.outside;
  wrong += other.wrong;
  longest_wrong_s = std::max(longest_wrong_s, other.longest_wrong_s);
  return *this;
}

std::array<ParameterEstimate, 3> parameters_of(const Estimate& estimate) {
  return {estimate.inertia, estimate.damping, estimate.stiffness};
}

std::array<double, 3> parameters_of(const WheelArm& arm) {
  return {arm.inertia_kgm2, arm.damping_nms_per_rad, arm.stiffness_nm_per_rad};
}

void ArmScore::take(const Estimate& said, const WheelArm& truth) {
  const std::array<ParameterEstimate, 3> estimates = parameters_of(said);
  const std::array<double, 3> truths = parameters_of(truth);
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    ParameterTicks& count = parameters_[i];
    ++count.ticks;
    const bool valid = estimates[i].state == ParameterState::kValid;
    const double error = std::abs(1e-6 * estimates[i].value_micro - truths[i]);
    const double scale = std::max(truths[i], kSmall[i]);
    const bool outside = valid && error > kInterval * 1e-6 * estimates[i].sd_micro;
    const bool wrong = outside && error > kTenth * scale;
    count.valid += valid;
    count.valid_close += valid && error <= kClose * scale;
    count.outside += outside;
    count.wrong += wrong;
    wrong_run_[i] = wrong ? wrong_run_[i] + 1 : 0;
    count.longest_wrong_s = std::max(count.longest_wrong_s, kTickS * static_cast<double>(wrong_run_[i]));
  }
}

std::array<ParameterTicks, 3> ticks_from(std::size_t first, const std::vector<Estimate>& said,
                                         const std::vector<WheelArm>& truth) {
  ArmScore score;
  for (std::size_t k = first; k < said.size(); ++k) score.take(said[k], truth[k]);
  return score.parameters();
}

}  // namespace steerid
