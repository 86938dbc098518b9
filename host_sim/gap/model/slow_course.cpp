// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/slow_course.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

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

/// The wheel whose course is looked for, in runs that all begin alike.
CourseFit course_fit(const SpectralRecord& record, const Point& at, const SlowPrior& prior, const SlowCourse* from,
                     unsigned threads) {
  RestartedRun run(record.record, record.stretches, record.between());
  std::vector<Effect> acting = at.effects;
  if (from != nullptr) acting.insert(acting.begin(), from->torque);
  run(at.wheel, acting);
  if (run.finite()) run.keep_starts();
  return {{.record = record.record,
           .stretches = run.stretches(),
           .between = record.between(),
           .knots_s = kKnots_s,
           .threads = threads},
          at.effects,
          at.wheel,
          prior};
}

/// H: what the linear wheel's recorded angle makes of a torque.
class LinearResponse {
 public:
  LinearResponse(const SpectralRecord& record, const Point& at)
      : record_(record), felt_(felt_by_noise(at, record.motion)), effects_(linear_in_plant(at.effects)) {
    late_ = set_parts_response(felt_, record.spectra.omega(), recorded_);
  }
  [[nodiscard]] Spectrum operator()(const Effect& torque) const {
    Spectrum out = linear_response(record_, felt_.wheel, effects_, torque);
    delay(out, record_.spectra.omega(), late_);
    if (recorded_.on_wheel.size() == 0) return out;
    return out.cwiseProduct(recorded_.gain).cwiseQuotient(recorded_.on_wheel);
  }

 private:
  const SpectralRecord& record_;
  Point felt_;
  std::vector<Effect> effects_;
  Response recorded_;
  double late_ = 0;
};

Eigen::VectorXd coefficients_of(const SlowCourse& course) {
  return Eigen::Map<const Eigen::VectorXd>(course.torque.time_course_nm.data(),
                                           std::ssize(course.torque.time_course_nm));
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
                       const SlowCourse* from, unsigned threads) {
  CourseFit fit = course_fit(record, at, prior, from, threads);
  const Eigen::VectorXd start = from != nullptr ? coefficients_of(*from) : Eigen::VectorXd::Zero(fit.knots());
  const Effect torque = fit.torque(fit.fit(start, rounds));
  return {.torque = torque, .response = LinearResponse(record, at)(torque)};
}

SlowCourse following(const SpectralRecord& record, const Parts& parts, const Eigen::VectorXd& x,
                     const std::vector<Fitted>& fitted, const SlowPrior& prior, const SlowCourse& course,
                     unsigned threads) {
  const Point at = Point::of(x, parts);
  std::vector<Beside> beside;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    Eigen::VectorXd moved = x;
    double& number = moved[static_cast<Eigen::Index>(i)];
    const double step = fitted[i].scale > 0 ? difference_step(fitted[i], number) : 0;
    number += step;
    const Point there = Point::of(moved, parts);
    beside.push_back({.wheel = there.wheel, .effects = there.effects, .step = step});
  }
  CourseFit fit = course_fit(record, at, prior, &course, threads);
  const CourseFit::Follows follows = fit.follows(coefficients_of(course), beside);
  SlowCourse::Following out{.from = x, .course_nm = follows.course_nm, .responses = {}, .slopes = {}};
  const LinearResponse linear(record, at);
  for (std::size_t i = 0; i < beside.size(); ++i) {
    const Spectrum none = Spectrum::Zero(record.spectra.bins());
    const bool moves = beside[i].step != 0;
    out.responses.push_back(moves ? linear(fit.torque(follows.course_nm.col(static_cast<Eigen::Index>(i)))) : none);
    out.slopes.push_back(moves ? Spectrum(out.responses.back() - record.made(follows.angle_rad[i])) : none);
  }
  SlowCourse with = course;
  with.follows = std::make_shared<const SlowCourse::Following>(std::move(out));
  return with;
}

SlowCourse SlowCourse::held_at(const Eigen::VectorXd& x) const {
  SlowCourse out{.torque = torque, .response = response};
  if (!follows) return out;
  const Eigen::VectorXd by = x - follows->from;
  const Eigen::VectorXd course = coefficients_of(*this) + follows->course_nm * by;
  out.torque.time_course_nm.assign(course.begin(), course.end());
  for (std::size_t i = 0; i < follows->responses.size(); ++i) {
    out.response += by[static_cast<Eigen::Index>(i)] * follows->responses[i];
  }
  return out;
}

}  // namespace steerid::gap
