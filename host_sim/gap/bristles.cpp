#include "gap/bristles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "plant/effects/vocabulary.hpp"

namespace steerid {
namespace {

constexpr double kStep_s = 5e-4;

/// The level at which bristles slip, Nm.
class Levels {
 public:
  explicit Levels(const Effect& friction) {
    if (friction.type == &effect::asymmetric_friction) {
      forward_ = friction.at("friction_forward_nm");
      backward_ = friction.at("friction_backward_nm");
    } else {
      forward_ = backward_ = friction.at("friction_nm");
    }
    if (friction.type == &effect::stribeck_friction) {
      more_ = friction.at("breakaway_ratio") - 1;
      per_rate_ = 1 / friction.at("stribeck_rate_rad_s");
    }
  }
  [[nodiscard]] double breakaway_nm() const { return (1 + more_) * std::max(forward_, backward_); }
  [[nodiscard]] double at(double rate_rad_s, bool forward) const {
    const double level = forward ? forward_ : backward_;
    if (more_ == 0) return level;
    const double ratio = rate_rad_s * per_rate_;
    return level * (1 + more_ * std::exp(-ratio * ratio));
  }

 private:
  double forward_ = 0;
  double backward_ = 0;
  double more_ = 0;
  double per_rate_ = 0;
};

/// Wheel and bristles; one leapfrog step is second order and neither damps nor delays.
struct Bristled {
  double angle_rad = 0;
  double rate_rad_s = 0;
  double bend_rad = 0;

  void step(const WheelArm& wheel, const Levels& levels, double per_bend_nm, double torque_nm, double next_nm,
            double h) {
    const double half = h / 2 / wheel.inertia_kgm2;
    const double middle = rate_rad_s + half * (torque_nm - wheel.damping_nms_per_rad * rate_rad_s -
                                               wheel.stiffness_nm_per_rad * angle_rad - per_bend_nm * bend_rad);
    angle_rad += h * middle;
    bend_rad += h * middle;
    const double level_nm = levels.at(middle, bend_rad > 0);
    if (per_bend_nm * std::abs(bend_rad) > level_nm) bend_rad = std::copysign(level_nm / per_bend_nm, bend_rad);
    rate_rad_s = (middle + half * (next_nm - wheel.stiffness_nm_per_rad * angle_rad - per_bend_nm * bend_rad)) /
                 (1 + half * wheel.damping_nms_per_rad);
  }
};

}  // namespace

bool is_dry(const EffectType& type) {
  return &type == &effect::coulomb_friction || &type == &effect::stribeck_friction ||
         &type == &effect::asymmetric_friction;
}

BristleRun::BristleRun(const Record& record, std::vector<RunStretch> stretches, TorqueSignal::Between between)
    : time_s_(record.time_s),
      stretches_(std::move(stretches)),
      angle_rad_(record.size(), std::numeric_limits<double>::quiet_NaN()) {
  std::vector<double> net_nm(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) net_nm[i] = record.net_torque_nm(i);
  const TorqueSignal torque = TorqueSignal::from_samples(time_s_, net_nm, between);
  for (std::size_t k = 0; k < torque.pieces(); ++k) torque_.push_back(torque.piece(k));
}

const std::vector<double>& BristleRun::operator()(const WheelArm& wheel, const Effect& friction, double bend_rad) {
  const Levels levels(friction);
  const double per_bend_nm = std::max(levels.breakaway_nm(), 1e-9) / bend_rad;
  for (const RunStretch& stretch : stretches_) {
    const WheelState from = stretch.initial.value_or(WheelState{});
    Bristled state{from.angle_rad, from.rate_rad_s, 0};
    angle_rad_[stretch.first] = state.angle_rad;
    for (std::size_t i = stretch.first; i + 1 < stretch.first + stretch.count; ++i) {
      const double interval_s = time_s_[i + 1] - time_s_[i];
      const double steps = std::ceil(interval_s / kStep_s - 1e-6);
      const double h = interval_s / steps;
      double torque_nm = torque_[i].at(0);
      for (double k = 1; k <= steps; ++k) {
        const double next_nm = torque_[i].at(k * h);
        state.step(wheel, levels, per_bend_nm, torque_nm, next_nm, h);
        torque_nm = next_nm;
      }
      angle_rad_[i + 1] = state.angle_rad;
    }
  }
  return angle_rad_;
}

BristleModel::BristleModel(const SpectralRecord& record, const EffectType& friction)
    : record_(record),
      type_(friction),
      run_(record.record, record.stretches,
           record.held ? TorqueSignal::Between::kHeld : TorqueSignal::Between::kBandLimited) {}

void BristleModel::evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& response) {
  Effect friction(type_);
  for (std::size_t i = 0; i < friction.values.size(); ++i) friction.values[i] = x[static_cast<Eigen::Index>(3 + i)];
  WheelArm wheel = wheel_of(x);
  const std::vector<double>& angle_rad = run_(wheel, friction, x[x.size() - 1]);
  wheel.stiffness_nm_per_rad = std::max(wheel.stiffness_nm_per_rad, 1e-3 * wheel.inertia_kgm2);
  const Eigen::VectorXd& omega = record_.spectra.omega();
  response.gain.resize(omega.size());
  for (Eigen::Index k = 0; k < omega.size(); ++k) response.gain[k] = wheel_response(wheel, omega[k]);
  response.ends = response.gain;
  residual = record_.angle - record_.spectra.of(angle_rad);
  if (!residual.allFinite()) residual = Spectrum::Constant(omega.size(), 1e6);
}

}  // namespace steerid
