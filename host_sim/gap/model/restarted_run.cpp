// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "gap/model/restarted_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "log/record_quality.hpp"

namespace steerid::gap {
namespace {

std::vector<double> slice(const std::vector<double>& column, const RunStretch& stretch) {
  const auto from = column.begin() + static_cast<std::ptrdiff_t>(stretch.first);
  return {from, from + static_cast<std::ptrdiff_t>(stretch.count)};
}

}  // namespace

double memory_s(const WheelArm& wheel) {
  if (!(wheel.stiffness_nm_per_rad > 0)) return std::numeric_limits<double>::infinity();
  return std::max(wheel.damping_nms_per_rad / wheel.stiffness_nm_per_rad,
                  2 * wheel.inertia_kgm2 / std::max(wheel.damping_nms_per_rad, 1e-9));
}

WheelArm within_run(const WheelArm& wheel, double run_s) {
  WheelArm held = wheel;
  held.stiffness_nm_per_rad =
      std::max(wheel.stiffness_nm_per_rad, std::sqrt(20.0) * wheel.inertia_kgm2 / (run_s * run_s) +
                                               std::sqrt(3.0) * wheel.damping_nms_per_rad / run_s);
  return held;
}

std::vector<RunStretch> run_stretches(const Record& record, const std::vector<Block>& blocks, bool anew_each_block) {
  constexpr double kAnew_s = 0.2;  // of a block of five seconds and more, so that little of it is fitted
  std::vector<RunStretch> stretches;
  for (const GapFreeRows& rows : gap_free_rows(record)) {
    const auto within = [&](const Block& block) { return rows.begin <= block.first && block.first < rows.end; };
    if (!anew_each_block && std::ranges::any_of(blocks, within)) {
      stretches.push_back({.first = rows.begin, .count = rows.size()});
    } else if (anew_each_block) {
      for (const Block& block : blocks) {
        if (within(block)) stretches.push_back({.first = block.first, .count = block.count, .begin_s = kAnew_s});
      }
    }
  }
  return stretches;
}

RestartedRun::RestartedRun(const Record& record, std::vector<RunStretch> stretches, TorqueSignal::Between between)
    : angle_rad_(record.size(), std::numeric_limits<double>::quiet_NaN()) {
  parts_.reserve(stretches.size());  // runs keep references to their records
  for (const RunStretch& stretch : stretches) {
    Part& part = parts_.emplace_back();
    part.stretch = stretch;
    part.record = {slice(record.time_s, stretch), slice(record.torque_driver_nm, stretch),
                   slice(record.torque_motor_nm, stretch), slice(record.angle_rad, stretch)};
    part.run = std::make_unique<FreeRun>(
        part.record, FreeRun::Options{.between = between, .origin_s = 0, .stretch_s = stretch.begin_s});
  }
}

std::span<const double> RestartedRun::operator()(const WheelArm& wheel, std::span<const Effect> effects) {
  finite_ = true;
  for (Part& part : parts_) {
    const std::span<const double> angle = (*part.run)(wheel, effects, part.stretch.initial);
    std::ranges::copy(angle, angle_rad_.begin() + static_cast<std::ptrdiff_t>(part.stretch.first));
    finite_ = finite_ && std::isfinite(angle.back());
  }
  return angle_rad_;
}

void RestartedRun::keep_starts() {
  for (Part& part : parts_) part.stretch.initial = part.run->initial();
}

std::vector<RunStretch> RestartedRun::stretches() const {
  std::vector<RunStretch> all;
  for (const Part& part : parts_) all.push_back(part.stretch);
  return all;
}

bool holds_itself(const Record& record, const std::vector<RunStretch>& stretches, const WheelArm& wheel,
                  std::span<const Effect> effects, TorqueSignal::Between between) {
  const auto [least, most] = std::ranges::minmax(record.angle_rad);
  const double apart_rad = 1e-3 * (most - least);
  std::vector<RunStretch> here = stretches;
  std::vector<RunStretch> further = stretches;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const WheelState begin = stretches[i].initial.value_or(WheelState{record.angle_rad[stretches[i].first], 0});
    here[i].initial = begin;
    further[i].initial = WheelState{begin.angle_rad + apart_rad, begin.rate_rad_s};
  }
  RestartedRun one(record, std::move(here), between);
  RestartedRun other(record, std::move(further), between);
  const std::span<const double> one_rad = one(wheel, effects);
  const std::span<const double> other_rad = other(wheel, effects);
  constexpr std::size_t kEnd = 100;  // samples
  return std::ranges::all_of(stretches, [&](const RunStretch& stretch) {
    const std::size_t end = stretch.first + stretch.count;
    for (std::size_t i = end - std::min(kEnd, stretch.count); i < end; ++i) {
      if (!(std::abs(other_rad[i] - one_rad[i]) <= apart_rad)) return false;
    }
    return true;
  });
}

std::vector<double> restarted_run(const Simulation& simulation, const Record& record,
                                  const std::vector<RunStretch>& stretches) {
  RestartedRun run(record, stretches, simulation.torque_between_samples);
  const std::span<const double> angle = run(simulation.wheel, simulation.effects);
  return {angle.begin(), angle.end()};
}

}  // namespace steerid::gap
