// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/hypotheses/hypotheses.hpp"

#include <algorithm>
#include <span>

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

/// What is beside the linear wheel's own side and the applied torque of a balance at one instant, Nm.
double added_nm(const Balance& now, const WheelArm& wheel, double net_torque_nm, double angle_rad, double rate_rad_s,
                double acceleration_rad_s2) {
  return now.torque_nm + (now.torque_driver_nm - now.torque_motor_nm - net_torque_nm) -
         (now.inertia_kgm2 - wheel.inertia_kgm2) * acceleration_rad_s2 -
         (now.damping_nms_per_rad - wheel.damping_nms_per_rad) * rate_rad_s -
         (now.stiffness_nm_per_rad * now.spring_angle_rad - wheel.stiffness_nm_per_rad * angle_rad);
}

}  // namespace

void Hypothesis::torque(const WheelArm& wheel, const double* values, const Record& record, const MeasuredMotion& motion,
                        std::vector<double>& torque_nm) const {
  const std::span all(values, type_.parameters.size());
  const RunSetting setting{.wheel = wheel, .replay = true};
  if (type_.on_record != nullptr) {
    const auto effect = type_.on_record(all, setting);
    for (std::size_t i = 0; i < record.size(); ++i) torque_nm[i] = effect->torque_correction_nm(motion.time_s[i]);
    return;
  }
  const auto effect = type_.in_plant(all, {}, setting);
  const PlantTraits traits = effect->traits();
  const std::span edges_rad(traits.edges_rad.data(), static_cast<std::size_t>(traits.edge_count));
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double angle_rad = motion.angle_rad[i];
    const double rate_rad_s = motion.rate_rad_s[i];
    const Instant now{.time_s = motion.time_s[i],
                      .angle_rad = angle_rad,
                      .rate_rad_s = rate_rad_s,
                      .step_middle_s = motion.time_s[i],
                      .direction = rate_rad_s < 0 ? -1 : 1,
                      .region = static_cast<int>(std::ranges::lower_bound(edges_rad, angle_rad) - edges_rad.begin()),
                      .slips = 0};
    Balance balance{.inertia_kgm2 = wheel.inertia_kgm2,
                    .damping_nms_per_rad = wheel.damping_nms_per_rad,
                    .stiffness_nm_per_rad = wheel.stiffness_nm_per_rad,
                    .spring_angle_rad = angle_rad,
                    .torque_driver_nm = record.torque_driver_nm[i],
                    .torque_motor_nm = record.torque_motor_nm[i],
                    .torque_nm = 0};
    effect->act(now, nullptr, nullptr, balance);
    torque_nm[i] =
        added_nm(balance, wheel, record.net_torque_nm(i), angle_rad, rate_rad_s, motion.acceleration_rad_s2[i]);
  }
}

const std::vector<std::unique_ptr<Hypothesis>>& hypotheses() {
  static const Hypotheses all = made();
  return all;
}

const Hypothesis* hypothesis_called(std::string_view id) {
  const auto found = std::ranges::find_if(hypotheses(), [&](const auto& one) { return one->type().id == id; });
  return found == hypotheses().end() ? nullptr : found->get();
}

const Hypothesis* hypothesis_of(const EffectType& type) { return hypothesis_called(type.id); }

}  // namespace steerid::gap
