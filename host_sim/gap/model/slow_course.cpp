// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/slow_course.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "gap/hypotheses/slow_share.hpp"
#include "gap/model/course_fit.hpp"
#include "gap/model/parts_response.hpp"

namespace steerid::gap {
namespace {

constexpr double kKnots_s = 0.5;  // half the power of a torque at 1 Hz is lost; hardly any slow torque has some there

/// The linear ones of what a torque passes.
std::vector<Effect> linear_in_plant(std::vector<Effect> effects) {
  std::erase_if(effects,
                [](const Effect& one) { return hypothesis_of(*one.type)->acts() || one.type->in_plant == nullptr; });
  return effects;
}

/// The spectrum of the angle of a linear wheel under a torque alone, from rest.
Spectrum linear_response(const SpectralRecord& record, const WheelArm& wheel, std::vector<Effect> effects,
                         const Effect& torque) {
  effects.push_back(torque);
  Record still = record.record;
  std::ranges::fill(still.torque_driver_nm, 0.0);
  std::ranges::fill(still.torque_motor_nm, 0.0);
  std::vector<RunStretch> stretches = record.stretches;
  for (RunStretch& stretch : stretches) stretch.initial = WheelState{};
  RestartedRun run(still, stretches, TorqueSignal::Between::kHeld);
  const std::span<const double> angle = run(wheel, effects);
  std::vector<double> moved(angle.begin(), angle.end());
  for (double& value : moved) value = std::isfinite(value) ? value : 0;
  return record.spectra.of(moved);
}

}  // namespace

SlowPrior slow_prior(const SpectralRecord& record, const Whittle& whittle, SlowTorque slow) {
  constexpr double kExact = 1e-4;  // of the angle: a channel without noise
  const double share = slow == SlowTorque::kCause ? kExpectedCauseShare : kUsualSlowShare;
  double square = 0;
  for (const double angle : record.motion.angle_rad) square += angle * angle;
  const double least = kExact * kExact * square / static_cast<double>(record.motion.angle_rad.size());
  const double step_rad = record.spectra.step_rad();
  return {.rms_nm = share * whittle.applied_rms_nm(),
          .angle_variance_rad2 = std::max(whittle.white().angle_variance, least) + step_rad * step_rad / 12};
}

SlowCourse slow_course(const SpectralRecord& record, const Point& at, const SlowPrior& prior, int rounds,
                       const SlowCourse* from) {
  RestartedRun run(record.record, record.stretches, record.between());
  std::vector<Effect> acting = at.effects;
  if (from != nullptr) acting.insert(acting.begin(), from->torque);
  run(at.wheel, acting);
  if (run.finite()) run.keep_starts();
  CourseFit fit(
      {.record = record.record, .stretches = run.stretches(), .between = record.between(), .knots_s = kKnots_s},
      at.effects, at.wheel, prior);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(fit.knots());
  if (from != nullptr) {
    start = Eigen::Map<const Eigen::VectorXd>(from->torque.time_course_nm.data(), fit.knots());
  }
  const Eigen::VectorXd course = fit.fit(std::move(start), rounds);
  SlowCourse out{.torque = fit.torque(course), .response = {}};
  const Point felt = felt_by_noise(at, record.motion);
  out.response = linear_response(record, felt.wheel, linear_in_plant(at.effects), out.torque);
  Response recorded;
  delay(out.response, record.spectra.omega(), set_parts_response(felt, record.spectra.omega(), recorded));
  if (recorded.on_wheel.size() > 0) {
    out.response = out.response.cwiseProduct(recorded.gain).cwiseQuotient(recorded.on_wheel).eval();
  }
  return out;
}

SlowCourse extrapolated(const SlowCourse& from, const SlowCourse& to, double times) {
  SlowCourse out = to;
  for (std::size_t i = 0; i < out.torque.time_course_nm.size(); ++i) {
    const double start = from.torque.time_course_nm[i];
    out.torque.time_course_nm[i] = start + times * (to.torque.time_course_nm[i] - start);
  }
  out.response = from.response + times * (to.response - from.response);
  return out;
}

}  // namespace steerid::gap
