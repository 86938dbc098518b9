// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "study/closed_loop.hpp"

#include <Eigen/LU>
#include <cmath>
#include <deque>

#include "identifier/differentiator.hpp"
#include "parallel/work_in_parallel.hpp"
#include "study/manoeuvres.hpp"

namespace steerid {
namespace {

constexpr WheelArm kArm{0.11, 1.5, 22.7};
constexpr double kSeconds = 60;
constexpr double kSettle_s = 5;

/// Answers to the angle of 150 ms ago and to the rate of 40 ms ago, and follows a slow course of his own.
Manoeuvre tracking(double gain, std::uint64_t seed) {
  return
      [=, past = std::deque<WheelState>(16), before = SignalPoint{},
       course = SmoothNoise({.rms = 0.5, .corner_hz = 0.3}, seed, kDriverStream)](const VirtualWheel& wheel) mutable {
        past.push_front(wheel.state());
        past.pop_back();
        const double torque = -gain * past[14].angle_rad - 0.02 * gain * past[3].rate_rad_s;
        const SignalPoint now{torque, (torque - before.value) / kTickS};
        before = now;
        Torques torques{.driver = course.next()};
        torques.driver += now;
        return torques;
      };
}

/// Least squares with the probe's own motion as instrument. One filter for all three signals, so that it cancels. The
/// instrument is the probe through a wheel near the true one: a wrong wheel there costs spread, it makes no bias.
class ProbeInstrument {
 public:
  void take(const Sample& sample) {
    const auto coefficients = second_order_coefficients(440.0, 30.0, kTickS);
    const double motor = 1e-3 * sample.torque_motor_mnm;
    torque_.push(torque_filter_.step(1e-3 * sample.torque_driver_mnm - motor, coefficients, kTickS));
    angle_.push(angle_filter_.step(1e-6 * sample.angle_urad, coefficients, kTickS));
    const auto wheel = second_order_coefficients(kArm.stiffness_nm_per_rad / kArm.inertia_kgm2,
                                                 kArm.damping_nms_per_rad / kArm.inertia_kgm2, kTickS);
    model_.push(wheel_.step(probe_filter_.step(-motor, coefficients, kTickS), wheel, kTickS));
    if (++ticks_ < static_cast<int>(kSettle_s / kTickS)) return;
    const Eigen::Vector3d z = model_.derivatives(1 / kTickS);
    information_ += z * angle_.derivatives(1 / kTickS).transpose();
    seen_ += z * torque_.derivatives(1 / kTickS)(2);
  }
  [[nodiscard]] Eigen::Vector3d answer() const { return information_.inverse() * seen_; }

 private:
  SecondOrderFilter<double> torque_filter_, angle_filter_, probe_filter_, wheel_;
  Differentiator<double> torque_, angle_, model_;
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d seen_ = Eigen::Vector3d::Zero();
  int ticks_ = 0;
};

struct Answers {
  Eigen::Vector3d recursive;
  Eigen::Vector3d probe;
  Eigen::Vector3d valid;
};

Answers drive(const ClosedLoopCase& what, std::uint64_t seed) {
  Manoeuvre torques = tracking(what.gain, seed);
  if (what.unmeasured_nm > 0) torques = together(torques, unmeasured(what.unmeasured_nm, seed));
  if (what.probe_rms_nm > 0) torques = together(torques, probe(seed, what.probe_rms_nm));
  VirtualDrive<double> wheel(kArm, seed);
  ProbeInstrument instrument;
  wheel.run(torques, kSeconds, [&](const Sample& sample) { instrument.take(sample); });
  Eigen::Vector3d valid;
  for (int i = 0; i < 3; ++i) valid(i) = wheel.identifier().belief(i) == Belief::kValid ? 1 : 0;
  return {wheel.identifier().value(), what.probe_rms_nm > 0 ? instrument.answer() : wheel.truth(), valid};
}

ClosedLoopBias bias_of(const std::vector<Eigen::Vector3d>& answers) {
  const Eigen::Vector3d truth(kArm.inertia_kgm2, kArm.damping_nms_per_rad, kArm.stiffness_nm_per_rad);
  const auto n = static_cast<double>(answers.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = sum;
  for (const Eigen::Vector3d& answer : answers) {
    const Eigen::Vector3d off = 100 * ((answer - truth).cwiseQuotient(truth));
    sum += off;
    squares += off.cwiseProduct(off);
  }
  const Eigen::Vector3d mean = sum / n;
  return {mean, ((squares / n - mean.cwiseProduct(mean)) / (n - 1)).cwiseMax(0.0).cwiseSqrt()};
}

}  // namespace

std::vector<ClosedLoopCase> closed_loop_cases() {
  std::vector<ClosedLoopCase> all;
  for (const double probe : {1.5, 0.5, 0.0}) {
    for (const double unmeasured : {0.0, 0.05, 0.15}) {
      for (const double gain : {0.0, 10.0}) {
        all.push_back({std::string(gain > 0 ? "feedback" : "open loop"), gain, unmeasured, probe});
      }
    }
  }
  return all;
}

ClosedLoopStudy run_closed_loop_study(std::size_t drives, std::uint64_t seed,
                                      const std::function<void(std::size_t)>& at) {
  const std::vector<ClosedLoopCase> all = closed_loop_cases();
  std::vector<std::vector<Eigen::Vector3d>> recursive(all.size(), std::vector<Eigen::Vector3d>(drives));
  auto probe = recursive;
  auto valid = recursive;
  work_in_parallel(all.size() * drives, 0, at, [&](std::size_t job) {
    const Answers answers = drive(all[job / drives], seed * 1'000'003 + job % drives);
    recursive[job / drives][job % drives] = answers.recursive;
    probe[job / drives][job % drives] = answers.probe;
    valid[job / drives][job % drives] = answers.valid;
  });
  ClosedLoopStudy study{drives, seed, {}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    Eigen::Vector3d share = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& one : valid[i]) share += one / static_cast<double>(drives);
    study.results.push_back({all[i], bias_of(recursive[i]), bias_of(probe[i]), share});
  }
  return study;
}

}  // namespace steerid
