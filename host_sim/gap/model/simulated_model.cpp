// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/simulated_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/model/parts_response.hpp"
#include "log/bad_input.hpp"

namespace steerid::gap {

namespace {

/// Whether something in it is over within a small part of a sample. No record shows that, and a run that follows it
/// takes many steps a sample: fits that stray there would last for minutes.
bool too_fast_to_show(const WheelArm& wheel, const std::vector<Effect>& effects, double rate_hz, double fastest_rad_s) {
  constexpr double kShortest = 0.1;  // samples
  return Plant(effects, {.wheel = wheel, .replay = true}).fastest_per_s(fastest_rad_s) > rate_hz / kShortest;
}

}  // namespace

SimulatedModel::SimulatedModel(const SpectralRecord& record, SpectralModel::Parts parts, std::vector<Effect> fixed,
                               std::shared_ptr<const SlowCourse> slow)
    : record_(record),
      parts_(std::move(parts)),
      fixed_(std::move(fixed)),
      slow_(std::move(slow)),
      run_(record.record, record.stretches, record.between()) {
  if (slow_) fixed_.push_back(slow_->torque);
  for (const double rate : record_.motion.rate_rad_s) fastest_rad_s_ = std::max(fastest_rad_s_, std::abs(rate));
}

std::span<const double> SimulatedModel::run(const Eigen::VectorXd& x) {
  const WheelArm wheel = wheel_of(x);
  const std::vector<Effect> effects = effects_at(x, parts_, fixed_);
  if (too_fast_to_show(wheel, effects, record_.rate_hz, fastest_rad_s_)) return {};
  const std::span<const double> angle_rad = run_(wheel, effects);
  return run_.finite() ? angle_rad : std::span<const double>();
}

double SimulatedModel::rms_rad(const Eigen::VectorXd& x, Block::Role role, std::span<const double> from_rad) {
  const std::span<const double> angle = run_(wheel_of(x), effects_at(x, parts_, fixed_));
  if (!run_.finite()) return std::numeric_limits<double>::infinity();
  if (from_rad.empty()) from_rad = record_.record.angle_rad;
  double squares = 0;
  double samples = 0;
  for (const BlockSpectra::Bins& bins : record_.spectra.blocks()) {
    if (bins.block.role != role) continue;
    for (std::size_t i = bins.block.first; i < bins.block.first + bins.block.count; ++i) {
      squares += std::pow(from_rad[i] - angle[i], 2);
    }
    samples += static_cast<double>(bins.block.count);
  }
  return std::sqrt(squares / std::max(samples, 1.0));
}

void SimulatedModel::evaluate(const Eigen::VectorXd& x, Spectrum& residual, Response& response) {
  const std::span<const double> angle = run(x);
  const Eigen::VectorXd& omega = record_.spectra.omega();
  delay(response.late, omega, set_parts_response(parts_, felt_by_noise(parts_, x, record_.motion), omega, response));
  if (angle.empty()) {  // diverged: as far from the record as can be
    // From line to line of another sign: what a block begins and ends with (gap/likelihood/whitened.cpp) would explain
    // a smooth one.
    residual = Spectrum::Constant(omega.size(), 1e6);
    for (Eigen::Index k = 1; k < omega.size(); k += 2) residual[k] = -1e6;
    return;
  }
  residual = record_.angle - record_.spectra.of(angle);
  if (slow_) residual += slow_->response;
}

}  // namespace steerid::gap
