#include "gap/slow_course.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "gap/course_fit.hpp"

namespace steerid {
namespace {

constexpr double kKnots_s = 0.5;  // half the power of a torque at 1 Hz is lost; hardly any slow torque has some there

/// The spectrum of the linear wheel's angle under a torque alone, from rest.
Spectrum linear_response(const SpectralRecord& record, const WheelArm& wheel, const Effect& torque) {
  Record still = record.record;
  std::ranges::fill(still.torque_driver_nm, 0.0);
  std::ranges::fill(still.torque_motor_nm, 0.0);
  std::vector<RunStretch> stretches = record.stretches;
  for (RunStretch& stretch : stretches) stretch.initial = WheelState{};
  RestartedRun run(still, stretches, TorqueSignal::Between::kHeld);
  const std::span<const double> angle = run(wheel, std::span(&torque, 1));
  std::vector<double> moved(angle.begin(), angle.end());
  for (double& value : moved) value = std::isfinite(value) ? value : 0;
  return record.spectra.of(moved);
}

}  // namespace

SlowCourse slow_course(const SpectralRecord& record, const std::vector<const EffectType*>& types,
                       const std::vector<Effect>& fixed, const Eigen::VectorXd& x, const SlowPrior& prior,
                       const SlowCourse* from) {
  constexpr int kRounds = 4;
  constexpr int kMoreRounds = 2;
  const WheelArm wheel = wheel_of(x);
  CourseFit fit(
      {.record = record.record, .stretches = record.stretches, .between = record.between(), .knots_s = kKnots_s},
      effects_at(x, types, fixed), wheel, prior);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(fit.knots());
  if (from != nullptr) {
    start = Eigen::Map<const Eigen::VectorXd>(from->torque.time_course_nm.data(), fit.knots());
  }
  const Eigen::VectorXd course = fit.fit(std::move(start), from == nullptr ? kRounds : kMoreRounds);
  SlowCourse out{.torque = fit.torque(course), .response = {}};
  out.response = linear_response(record, wheel, out.torque);
  return out;
}

}  // namespace steerid
