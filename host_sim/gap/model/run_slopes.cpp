// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/run_slopes.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace steerid::gap {

RunSlopes::RunSlopes(const SpectralRecord& record, Parts parts)
    : record_(record),
      parts_(std::move(parts)),
      on_motion_(record, parts_),
      momentary_(!record.anew_each_block && !parts_.empty() && std::ranges::all_of(parts_, [](const Hypothesis* part) {
        return part->acts() && part->momentary();
      })) {}

std::vector<double> RunSlopes::torque_nm(const Point& at, const MeasuredMotion& motion) const {
  std::vector<double> sum(record_.record.size(), 0.0);
  std::vector<double> own(sum.size());
  for (const Effect& effect : at.effects) {
    hypothesis_of(*effect.type)->torque(at.wheel, effect.values.data(), record_.record, motion, own);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
  }
  return sum;
}

std::vector<double> RunSlopes::moved(const WheelArm& wheel, const Lost& lost,
                                     const std::vector<double>& driving_nm) const {
  const double h = 1 / kResampledRateHz;
  std::vector<double> out(driving_nm.size(), 0.0);
  for (const RunStretch& stretch : record_.stretches) {
    double angle = 0;
    double rate = 0;
    double acceleration = 0;
    for (std::size_t i = stretch.first; i < stretch.first + stretch.count; ++i) {
      const double inertia = wheel.inertia_kgm2 + (lost.inertia.empty() ? 0 : lost.inertia[i]);
      const double damping = wheel.damping_nms_per_rad + lost.damping[i];
      const double stiffness = wheel.stiffness_nm_per_rad + lost.stiffness[i];
      const double rate_before = rate + h / 2 * acceleration;
      const double angle_before = angle + h * rate + h * h / 4 * acceleration;
      acceleration = (driving_nm[i] - damping * rate_before - stiffness * angle_before) /
                     (inertia + h / 2 * damping + h * h / 4 * stiffness);
      rate = rate_before + h / 2 * acceleration;
      angle = angle_before + h * h / 4 * acceleration;
      out[i] = angle;
    }
  }
  return out;
}

std::vector<double> RunSlopes::lost_along(const Point& at, std::vector<double> MeasuredMotion::*channel) const {
  constexpr double kSmall = 1e-4;  // of the motion: fine beside a ripple's cycle, coarse beside the last digits
  MeasuredMotion beside = record_.motion;
  const auto [least, most] = std::ranges::minmax(beside.*channel);
  const double step = kSmall * std::max({-least, most, 1e-12});
  for (double& value : beside.*channel) value -= step;
  std::vector<double> lost = torque_nm(at, beside);
  for (double& value : beside.*channel) value += 2 * step;
  const std::vector<double> above = torque_nm(at, beside);
  for (std::size_t i = 0; i < lost.size(); ++i) lost[i] = (lost[i] - above[i]) / (2 * step);
  return lost;
}

std::vector<Spectrum> RunSlopes::at(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  if (!momentary_) return differences(on_motion_, x, fitted);
  const MeasuredMotion& motion = record_.motion;
  const Point point = Point::of(x, parts_);
  Lost lost{.inertia = {},
            .damping = lost_along(point, &MeasuredMotion::rate_rad_s),
            .stiffness = lost_along(point, &MeasuredMotion::angle_rad)};
  if (std::ranges::any_of(parts_, [](const Hypothesis* part) { return part->knows().inertia; })) {
    lost.inertia = lost_along(point, &MeasuredMotion::acceleration_rad_s2);
  }
  const std::array wheels_own = {&motion.acceleration_rad_s2, &motion.rate_rad_s, &motion.angle_rad};
  const std::vector<double> torque = torque_nm(point, motion);
  std::vector<Spectrum> along;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    along.emplace_back(Spectrum::Zero(record_.spectra.bins()));
    if (!(fitted[i].scale > 0)) continue;
    Eigen::VectorXd beside = x;
    double& number = beside[static_cast<Eigen::Index>(i)];
    const double step = difference_step(fitted[i], number);
    number += step;
    std::vector<double> driving = torque_nm(Point::of(beside, parts_), motion);
    for (std::size_t k = 0; k < driving.size(); ++k) {
      driving[k] = (driving[k] - torque[k]) / step;
      if (i < wheels_own.size()) driving[k] -= (*wheels_own[i])[k];
    }
    along.back() = -record_.made(moved(point.wheel, lost, driving));
  }
  return along;
}

}  // namespace steerid::gap
