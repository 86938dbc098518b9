// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/hypotheses/hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "gap/hypotheses/torque_on_motion.hpp"

namespace steerid::gap {

namespace {

Hypotheses made() {
  Hypotheses all;
  add_friction_hypotheses(all);
  add_spring_hypotheses(all);
  add_time_hypotheses(all);
  add_response_hypotheses(all);
  add_hands_off_hypothesis(all);
  return all;
}

}  // namespace

void Hypothesis::restate(const Span& /*record*/, double* values, WheelArm* /*wheel*/) const {
  if (traits_.linear.phase < 0) return;
  double& phase = values[traits_.linear.phase];
  phase = std::remainder(phase, 2 * std::numbers::pi);
}

std::vector<std::vector<double>> Hypothesis::missed(const std::vector<double>& values) const {
  std::vector<std::vector<double>> others;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& of = type_.parameters[i];
    for (double choice = of.low; of.whole && choice <= of.high; ++choice) {
      if (choice == values[i]) continue;
      others.push_back(values);
      others.back()[i] = choice;
    }
  }
  return others;
}

void Hypothesis::torque(const WheelArm& wheel, const double* values, const Record& record, const MeasuredMotion& motion,
                        std::vector<double>& torque_nm) const {
  const std::span all(values, type_.parameters.size());
  const RunSetting setting{.wheel = wheel, .replay = true};
  if (type_.on_record != nullptr) {
    const auto effect = type_.on_record(all, setting);
    for (std::size_t i = 0; i < record.size(); ++i) torque_nm[i] = effect->torque_correction_nm(motion.time_s[i]);
    return;
  }
  torque_on_motion(*type_.in_plant(all, {}, setting), wheel, record, motion, torque_nm);
}

const std::vector<std::unique_ptr<Hypothesis>>& hypotheses() {
  static const Hypotheses all = made();
  return all;
}

const Hypothesis* hypothesis_of(const EffectType& type) {
  const auto found = std::ranges::find_if(hypotheses(), [&](const auto& one) { return &one->type() == &type; });
  return found == hypotheses().end() ? nullptr : found->get();
}

}  // namespace steerid::gap
