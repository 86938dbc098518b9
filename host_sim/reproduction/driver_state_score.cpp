// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduction/driver_state_score.hpp"

#include <cmath>

#include "app/driver_state.hpp"
#include "parallel/work_in_parallel.hpp"
#include "reproduction/identified_record.hpp"

namespace steerid {
namespace {

constexpr double kSettled_s = 5.0;
constexpr std::size_t kStays = 100;  // ticks

std::size_t tick_at(double time_s) { return static_cast<std::size_t>(std::llround(time_s / kTickS)); }

/// When, from `first` on, `state` is told for kStays ticks in a row.
std::optional<std::size_t> told_from(std::span<const Estimate> estimates, std::size_t first, std::size_t end,
                                     DriverState state) {
  std::size_t in_a_row = 0;
  for (std::size_t i = first; i < end; ++i) {
    in_a_row = estimates[i].driver == state ? in_a_row + 1 : 0;
    if (in_a_row == kStays) return i + 1 - kStays;
  }
  return std::nullopt;
}

}  // namespace

DriverState state_of_exact(const WheelArm& arm) {
  const auto exact = [](double value) {
    return ParameterEstimate{static_cast<std::int32_t>(std::lround(value * 1e6)), 0, ParameterState::kValid};
  };
  const DriverEvidence evidence{exact(arm.inertia_kgm2), exact(arm.damping_nms_per_rad),
                                exact(arm.stiffness_nm_per_rad), 1000};
  DriverStateObserver observer;
  for (int i = 0; i < DriverStateObserver::kConfirm; ++i) observer.take(evidence);
  return observer.state(evidence);
}

double DriverStateScore::told_share(const Confusion& table) const {
  double told = 0;
  double all = 0;
  for (const auto& row : table) {
    for (std::size_t said = 0; said < row.size(); ++said) {
      all += row[said];
      told += said == 0 ? 0 : row[said];
    }
  }
  return all > 0 ? told / all : 0;
}

double DriverStateScore::wrong_share(const Confusion& table) const {
  double told = 0;
  double wrong = 0;
  for (std::size_t truth = 0; truth < table.size(); ++truth) {
    for (std::size_t said = 1; said < table[truth].size(); ++said) {
      told += table[truth][said];
      wrong += said == truth ? 0 : table[truth][said];
    }
  }
  return told > 0 ? wrong / told : 0;
}

void score_drive(std::span<const Stretch> truth, std::span<const Estimate> estimates, DriverStateScore& score) {
  ++score.drives;
  for (std::size_t s = 0; s < truth.size(); ++s) {
    const Stretch& stretch = truth[s];
    const std::size_t first = tick_at(stretch.from_s);
    const std::size_t end = std::min(tick_at(stretch.to_s), estimates.size());
    for (std::size_t i = first; i < end; ++i) {
      const auto told = static_cast<std::size_t>(estimates[i].driver);
      score.state[static_cast<std::size_t>(stretch.state)][told] += kTickS;
      score.hands[static_cast<std::size_t>(stretch.hands)][static_cast<std::size_t>(estimates[i].hands)] += kTickS;
      if (i < first + tick_at(kSettled_s)) continue;
      score.state_settled[static_cast<std::size_t>(stretch.state)][told] += kTickS;
    }
    if (state_of_exact(stretch.arm) != stretch.state) score.overlapping_s += stretch.to_s - stretch.from_s;
    const DriverState before = s == 0 ? DriverState::kUnknown : truth[s - 1].state;
    if (before == stretch.state) continue;
    const std::optional<std::size_t> at = told_from(estimates, first, end, stretch.state);
    std::optional<double> after;
    if (at) after = static_cast<double>(*at - first) * kTickS;
    score.detections.push_back({before, stretch.state, after});
  }
}

DriverStateScore score_driver_state(const ExperimentSettings& settings, const std::vector<VirtualSubject>& subjects,
                                    double probe_rms_nm, const std::function<void(std::size_t done)>& at_drive) {
  const std::size_t drives = 3 * subjects.size();
  std::vector<TakeOverDrive> driven(drives);
  std::vector<std::vector<Estimate>> told(drives);
  work_in_parallel(drives, settings.threads, at_drive, [&](std::size_t i) {
    TakeOverSettings what;
    what.one_hand = kAllHandPositions[i % 3];
    what.probe_rms_nm = probe_rms_nm;
    what.unmeasured_percent = settings.unmeasured_percent;
    what.stiffness_swing = settings.stiffness_swing;
    what.seed = settings.seed * 1000 + i;
    driven[i] = make_take_over_drive(subjects[i / 3], what);
    told[i] = firmware_estimates(driven[i].record);
  });
  DriverStateScore score;
  for (std::size_t i = 0; i < drives; ++i) score_drive(driven[i].truth, told[i], score);
  return score;
}

}  // namespace steerid
