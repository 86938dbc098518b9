// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/simulated_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/model/parts_response.hpp"
#include "log/bad_input.hpp"
#include "parallel/work_in_parallel.hpp"

namespace steerid::gap {

namespace {

/// Whether something in it is over within a small part of a sample. No record shows that, and a run that follows it
/// takes many steps a sample: fits that stray there would last for minutes.
bool too_fast_to_show(const WheelArm& wheel, const std::vector<Effect>& effects, double fastest_rad_s) {
  constexpr double kShortest = 0.1;  // samples
  return Plant(effects, {.wheel = wheel, .replay = true}).fastest_per_s(fastest_rad_s) > kResampledRateHz / kShortest;
}

}  // namespace

SimulatedModel::SimulatedModel(const SpectralRecord& record, Parts parts, std::shared_ptr<const SlowCourse> slow,
                               unsigned threads)
    : record_(record),
      parts_(std::move(parts)),
      slow_(std::move(slow)),
      threads_(threads_of(threads)),
      run_(record.record, record.stretches, record.between()) {
  for (const double rate : record_.motion.rate_rad_s) fastest_rad_s_ = std::max(fastest_rad_s_, std::abs(rate));
}

std::span<const double> SimulatedModel::run(const Point& at) {
  return run_with(at, slow_ ? slow_->held_at(at.numbers()) : SlowCourse{});
}

std::span<const double> SimulatedModel::run_with(const Point& at, const SlowCourse& slow) {
  std::vector<Effect> effects = at.effects;
  if (slow_) effects.insert(effects.begin(), slow.torque);
  if (too_fast_to_show(at.wheel, effects, fastest_rad_s_)) return {};
  const std::span<const double> angle_rad = run_(at.wheel, effects);
  return run_.finite() ? angle_rad : std::span<const double>();
}

Spectrum SimulatedModel::residual_at(const Point& at) {
  const SlowCourse slow = slow_ ? slow_->held_at(at.numbers()) : SlowCourse{};
  const std::span<const double> angle = run_with(at, slow);
  if (angle.empty()) {  // diverged: as far from the record as can be
    // From line to line of another sign: what a block begins and ends with (gap/likelihood/whitened.cpp) would explain
    // a smooth one.
    Spectrum far = Spectrum::Constant(record_.spectra.bins(), 1e6);
    for (Eigen::Index k = 1; k < far.size(); k += 2) far[k] = -1e6;
    return far;
  }
  Spectrum residual = record_.angle - record_.made(angle);
  if (slow_) residual += slow.response;
  return residual;
}

void SimulatedModel::evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& response) {
  const Point at = Point::of(x, parts_);
  const Eigen::VectorXd& omega = record_.spectra.omega();
  residual = residual_at(at);
  delay(response.late, omega, set_parts_response(felt_by_noise(at, record_.motion), omega, response));
}

std::vector<Spectrum> SimulatedModel::residuals_at(std::span<const Eigen::VectorXd> points) {
  std::vector<Spectrum> all(points.size());
  const std::size_t workers = std::min<std::size_t>(threads_, points.size());
  while (others_.size() + 1 < workers) {
    others_.push_back(std::make_unique<SimulatedModel>(record_, parts_, slow_));
  }
  share_among(workers, points.size(), [&](std::size_t worker, std::size_t i) {
    SimulatedModel& own = worker == 0 ? *this : *others_[worker - 1];
    all[i] = own.residual_at(Point::of(points[i], parts_));
  });
  return all;
}

}  // namespace steerid::gap
