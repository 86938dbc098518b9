// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Figure 7's fit over what decides it: how far the driver's stiffness drifts and how much torque no sensor sees. Both
// are put in, so the fit at one choice of them says little; over them it says how good a wheel and its sensors have to
// be for the paper's figure.
#pragma once

#include <functional>
#include <vector>

#include "reproduction/table_rows.hpp"

namespace steerid {

struct FitPoint {
  double stiffness_swing = 0;
  double unmeasured_percent = 0;
  Accuracy accuracy;  ///< of both tasks, kSweptSubjects subjects at 3 o'clock, as the paper excites
};

inline constexpr std::array kSweptSwings{0.0, 0.0075, 0.02, 0.05, 0.1, 0.2};
inline constexpr std::array kSweptUnmeasured_percent{0.0, 0.3, 1.0, 2.0, 5.0, 10.0};
inline constexpr std::size_t kSweptSubjects = 5;
inline constexpr std::size_t kFitSweepRecords =
    (kSweptSwings.size() + kSweptUnmeasured_percent.size()) * kSteeringTasks.size() * kSweptSubjects;

struct FitSweep {
  std::vector<FitPoint> over_swing;       ///< at the settings' unmeasured torque
  std::vector<FitPoint> over_unmeasured;  ///< at the settings' drift
};

[[nodiscard]] FitSweep fit_sweep(
    const ExperimentSettings& settings, const std::vector<VirtualSubject>& subjects,
    const std::function<void(std::size_t done)>& at_record = [](std::size_t) {});

}  // namespace steerid
