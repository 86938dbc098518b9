// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "plant/free_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "plant/recorder.hpp"

namespace steerid {
namespace {

constexpr double kTiny = 1e-9;  // of squares in rad, s and rad/s

}  // namespace

FreeRun::FreeRun(const Record& record, Options options) : record_(record), options_(options) {
  if (record.size() < 2) throw std::invalid_argument("a free run needs a record of two samples or more");
  const double origin = options_.origin_s.value_or(record.time_s.front());
  sample_s_.reserve(record.size());
  for (const double stamp : record.time_s) sample_s_.push_back(stamp - origin);
  interpolate(record.torque_driver_nm, record.torque_motor_nm);
  correction_nm_.resize(record.size());
  const double end = sample_s_.front() + options_.stretch_s;
  const auto within = std::ranges::upper_bound(sample_s_, end) - sample_s_.begin();
  stretch_ = std::min(record.size(), std::max<std::size_t>(static_cast<std::size_t>(within), 8));
  prepare_time(0);
}

void FreeRun::interpolate(std::span<const double> driver_nm, std::span<const double> motor_nm) {
  const auto driver = TorqueSignal::from_samples(sample_s_, driver_nm, options_.between);
  const auto motor = TorqueSignal::from_samples(sample_s_, motor_nm, options_.between);
  driver_.resize(driver.pieces());
  motor_.resize(motor.pieces());
  for (std::size_t k = 0; k < driver.pieces(); ++k) {
    driver_[k] = driver.piece(k);
    motor_[k] = motor.piece(k);
  }
}

void FreeRun::prepare_torque(const RecordEffects& effects) {
  corrected_ = false;
  bool repairs = false;
  for (const auto& effect : effects) {
    corrected_ = corrected_ || effect->corrects_torque();
    repairs = repairs || effect->repairs_torque();
  }
  if (repairs) {
    repaired_driver_ = record_.torque_driver_nm;
    repaired_motor_ = record_.torque_motor_nm;
    for (const auto& effect : effects) {
      effect->repair_torque(repaired_driver_);
      effect->repair_torque(repaired_motor_);
    }
    interpolate(repaired_driver_, repaired_motor_);
  } else if (repaired_) {
    interpolate(record_.torque_driver_nm, record_.torque_motor_nm);
  }
  repaired_ = repairs;
  if (!corrected_) return;
  std::ranges::fill(correction_nm_, 0.0);
  for (const auto& effect : effects) {
    if (!effect->corrects_torque()) continue;
    for (std::size_t i = 0; i < correction_nm_.size(); ++i) {
      correction_nm_[i] += effect->torque_correction_nm(sample_s_[i]);
    }
  }
}

/// Nodes before and after the record, at its mean interval, as far as the effects reach.
void FreeRun::prepare_time(double reach_s) {
  const std::size_t samples = sample_s_.size();
  const double interval = (sample_s_.back() - sample_s_.front()) / static_cast<double>(samples - 1);
  const std::size_t pad = reach_s > 0 ? static_cast<std::size_t>(std::ceil(reach_s / interval)) + 1 : 0;
  if (pad == first_ && !time_s_.empty()) return;
  first_ = pad;
  time_s_.resize(samples + 2 * pad);
  angle_rad_.resize(time_s_.size());
  rate_rad_s_.resize(time_s_.size());
  std::ranges::copy(sample_s_, time_s_.begin() + static_cast<std::ptrdiff_t>(pad));
  for (std::size_t i = 1; i <= pad; ++i) {
    time_s_[pad - i] = sample_s_.front() - interval * static_cast<double>(i);
    time_s_[pad + samples - 1 + i] = sample_s_.back() + interval * static_cast<double>(i);
  }
}

void FreeRun::run_plant(Plant& plant, const WheelState& from, std::size_t nodes) {
  plant.start(time_s_.front(), from);
  angle_rad_[0] = from.angle_rad;
  rate_rad_s_[0] = from.rate_rad_s;
  const std::size_t last_sample = sample_s_.size() - 1;
  for (std::size_t i = 1; i < nodes; ++i) {
    const double span = time_s_[i] - time_s_[i - 1];
    Cubic driver;
    Cubic motor;
    if (i <= first_ || i > first_ + last_sample) {  // beyond the record its end values hold
      const std::size_t end = i <= first_ ? 0 : last_sample;
      const auto& held_driver = repaired_ ? repaired_driver_ : record_.torque_driver_nm;
      const auto& held_motor = repaired_ ? repaired_motor_ : record_.torque_motor_nm;
      driver.c0 = held_driver[end] + (corrected_ ? correction_nm_[end] : 0);
      motor.c0 = held_motor[end];
    } else {
      const std::size_t k = i - 1 - first_;
      driver = driver_[k];
      motor = motor_[k];
      if (corrected_) {  // slow beside the sampling: straight between samples
        driver.c0 += correction_nm_[k];
        driver.c1 += (correction_nm_[k + 1] - correction_nm_[k]) / span;
      }
    }
    plant.advance(driver, motor, span);
    const WheelState state = plant.state();
    angle_rad_[i] = state.angle_rad;
    rate_rad_s_[i] = state.rate_rad_s;
  }
}

void FreeRun::pass_record(const RecordEffects& effects, std::size_t nodes, bool converters) {
  Trajectory run{std::span(time_s_).first(nodes), std::span(angle_rad_).first(nodes),
                 std::span(rate_rad_s_).first(nodes), first_, record_.angle_rad};
  for (const auto& effect : effects) {
    if (converters || !effect->converter()) effect->record(run);
  }
}

/// Fills residual_ over the first stretch and returns its sum of squares: infinite where the run does not stay finite.
double FreeRun::misfit(Plant& plant, const RecordEffects& effects, const WheelState& from) {
  const std::size_t nodes = std::min(time_s_.size(), stretch_ + 2 * first_);
  run_plant(plant, from, nodes);
  pass_record(effects, nodes, false);
  residual_.resize(stretch_);
  double sum = 0;
  for (std::size_t i = 0; i < stretch_; ++i) {
    const double run = angle_rad_[node(i)];
    if (!std::isfinite(run)) return std::numeric_limits<double>::infinity();
    const double residual = record_.angle_rad[i] - run;
    residual_[i] = std::isfinite(residual) ? residual : 0;  // a sample that the record lacks
    sum += residual_[i] * residual_[i];
  }
  return sum;
}

double FreeRun::mean_square_rate(std::size_t apart) const {
  double sum = 0;
  double count = 0;
  for (std::size_t i = apart; i < record_.size(); i += apart) {
    const double rate_rad_s =
        (record_.angle_rad[i] - record_.angle_rad[i - apart]) / (sample_s_[i] - sample_s_[i - apart]);
    if (!std::isfinite(rate_rad_s)) continue;
    sum += rate_rad_s * rate_rad_s;
    count += 1;
  }
  return std::max(sum / std::max(count, 1.0), kTiny);
}

WheelState FreeRun::estimate_initial(Plant& plant, const RecordEffects& effects) {
  constexpr double kAngleStep = 1e-4;
  constexpr double kRateStep = 1e-3;
  const auto& angle = record_.angle_rad;
  const std::size_t near = std::min<std::size_t>(stretch_ - 1, 4);
  WheelState state{angle[0], (angle[near] - angle[0]) / (sample_s_[near] - sample_s_[0])};
  if (!std::isfinite(state.angle_rad)) state.angle_rad = 0;
  if (!std::isfinite(state.rate_rad_s)) state.rate_rad_s = 0;
  // What a run lacks is no reason to start it faster than the wheel ever turns. With noise of unknown size and a normal
  // prior of the rate, minus twice the log posterior over the samples is log(sum) + (rate / deviation)^2 / samples.
  const double samples = static_cast<double>(stretch_);
  const double usual = mean_square_rate(near);
  const auto merit = [&](double sum, const WheelState& at) {
    return sum * std::exp(at.rate_rad_s * at.rate_rad_s / (usual * samples));
  };
  double sum = misfit(plant, effects, state);
  for (int iteration = 0; iteration < 8 && std::isfinite(sum); ++iteration) {
    base_ = residual_;
    misfit(plant, effects, {state.angle_rad + kAngleStep, state.rate_rad_s});
    by_angle_ = residual_;
    misfit(plant, effects, {state.angle_rad, state.rate_rad_s + kRateStep});
    const double ridge = sum / (usual * samples);  // a stuck wheel does not answer to its rate at all
    double aa = kTiny;
    double ab = 0;
    double bb = ridge + kTiny;
    double ga = 0;
    double gb = -ridge * state.rate_rad_s;
    for (std::size_t i = 0; i < stretch_; ++i) {
      const double a = (base_[i] - by_angle_[i]) / kAngleStep;  // derivative of the predicted angle
      const double b = (base_[i] - residual_[i]) / kRateStep;
      aa += a * a;
      ab += a * b;
      bb += b * b;
      ga += a * base_[i];
      gb += b * base_[i];
    }
    const double determinant = aa * bb - ab * ab;
    double angle_change = (bb * ga - ab * gb) / determinant;
    double rate_change = (aa * gb - ab * ga) / determinant;
    // Halve the step until it helps; when it never does the estimate stands.
    bool better = false;
    for (int halving = 0; halving < 5 && !better; ++halving) {
      const WheelState trial{state.angle_rad + angle_change, state.rate_rad_s + rate_change};
      const double trial_sum = misfit(plant, effects, trial);
      better = merit(trial_sum, trial) < merit(sum, state);
      if (better) {
        state = trial;
        sum = trial_sum;
      } else {
        angle_change /= 2;
        rate_change /= 2;
      }
    }
    if (!better || (std::abs(angle_change) < 1e-7 && std::abs(rate_change) < 1e-6)) break;
  }
  return state;
}

std::span<const double> FreeRun::operator()(const WheelArm& wheel, std::span<const Effect> effects,
                                            const std::optional<WheelState>& initial) {
  const RunSetting setting{.wheel = wheel, .replay = true};
  Plant plant(effects, setting);
  plant.refine(refinement_);
  const RecordEffects recorded = record_effects(effects, setting);
  double reach_s = 0;
  for (const auto& effect : recorded) reach_s += effect->reach_s();
  prepare_torque(recorded);
  prepare_time(reach_s);
  initial_ = initial ? *initial : estimate_initial(plant, recorded);
  run_plant(plant, initial_, time_s_.size());
  pass_record(recorded, time_s_.size(), true);
  return std::span<const double>(angle_rad_).subspan(first_, sample_s_.size());
}

}  // namespace steerid
