#include "gap/model/run_slopes.hpp"

#include <algorithm>
#include <utility>

namespace steerid {

RunSlopes::RunSlopes(const SpectralRecord& record, SpectralModel::Parts parts)
    : record_(record),
      parts_(std::move(parts)),
      on_motion_(record, parts_),
      momentary_(!record.anew_each_block && !parts_.empty() && std::ranges::all_of(parts_, [](const Hypothesis* part) {
        return part->acts() && part->momentary();
      })) {}

std::vector<double> RunSlopes::torque_nm(const Eigen::VectorXd& x, const MeasuredMotion& motion) const {
  std::vector<double> sum(record_.record.size(), 0.0);
  std::vector<double> own(sum.size());
  const double* values = x.data() + 3;
  for (const Hypothesis* part : parts_) {
    part->torque(wheel_of(x), values, record_.record, motion, own);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
    values += part->type().parameters.size();
  }
  return sum;
}

std::vector<double> RunSlopes::moved(const WheelArm& wheel, const std::vector<double>& damping_change,
                                     const std::vector<double>& stiffness_change,
                                     const std::vector<double>& driving_nm) const {
  const double h = 1 / record_.rate_hz;
  std::vector<double> out(driving_nm.size(), 0.0);
  for (const RunStretch& stretch : record_.stretches) {
    double angle = 0;
    double rate = 0;
    double acceleration = 0;
    for (std::size_t i = stretch.first; i < stretch.first + stretch.count; ++i) {
      const double damping = wheel.damping_nms_per_rad + damping_change[i];
      const double stiffness = wheel.stiffness_nm_per_rad + stiffness_change[i];
      const double rate_before = rate + h / 2 * acceleration;
      const double angle_before = angle + h * rate + h * h / 4 * acceleration;
      acceleration = (driving_nm[i] - damping * rate_before - stiffness * angle_before) /
                     (wheel.inertia_kgm2 + h / 2 * damping + h * h / 4 * stiffness);
      rate = rate_before + h / 2 * acceleration;
      angle = angle_before + h * h / 4 * acceleration;
      out[i] = angle;
    }
  }
  return out;
}

std::vector<Spectrum> RunSlopes::at(const Eigen::VectorXd& x, const std::vector<Fitted>& fitted) {
  if (!momentary_) return DifferencedSlopes(on_motion_).at(x, fitted);
  constexpr double kSmall = 1e-4;  // of the motion: fine beside a ripple's cycle, coarse beside the last digits
  const MeasuredMotion& motion = record_.motion;
  const auto largest = [](const std::vector<double>& of) {
    const auto [least, most] = std::ranges::minmax(of);
    return std::max({-least, most, 1e-12});
  };
  const std::vector<double> torque = torque_nm(x, motion);
  /// Minus the torque's slope in one of the motion's channels, by a difference to either side.
  const auto slope = [&](std::vector<double> MeasuredMotion::*channel) {
    const double step = kSmall * largest(motion.*channel);
    MeasuredMotion beside = motion;
    for (double& value : beside.*channel) value += step;
    std::vector<double> change = torque_nm(x, beside);
    for (double& value : beside.*channel) value -= 2 * step;
    const std::vector<double> below = torque_nm(x, beside);
    for (std::size_t i = 0; i < change.size(); ++i) change[i] = -(change[i] - below[i]) / (2 * step);
    return change;
  };
  const std::vector<double> damping_change = slope(&MeasuredMotion::rate_rad_s);
  const std::vector<double> stiffness_change = slope(&MeasuredMotion::angle_rad);
  std::vector<Spectrum> along;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    along.emplace_back(Spectrum::Zero(record_.spectra.bins()));
    if (!(fitted[i].scale > 0)) continue;
    Eigen::VectorXd beside = x;
    const auto at = static_cast<Eigen::Index>(i);
    const double step = difference_step(fitted[i], x[at]);
    beside[at] += step;
    std::vector<double> driving = torque_nm(beside, motion);
    const std::vector<double>* const channels[] = {&motion.acceleration_rad_s2, &motion.rate_rad_s, &motion.angle_rad};
    for (std::size_t k = 0; k < driving.size(); ++k) {
      driving[k] = (driving[k] - torque[k]) / step - (i < 3 ? (*channels[i])[k] : 0);
    }
    along.back() = -record_.spectra.of(moved(wheel_of(x), damping_change, stiffness_change, driving));
  }
  return along;
}

}  // namespace steerid
