// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How well the firmware tells the driver's state: over take-over drives whose truth is known.
//
//   confusion   share of the time of each true state in which each state was told
//   wrong       share of all told (not unknown) time in which another state was told than the true one
//   detection   seconds from a change to the first instant at which the new state is told and stays told for a second;
//               nothing when that does not happen before the next change
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "reproduction/experiment_run.hpp"
#include "reproduction/take_over_drive.hpp"

namespace steerid {

/// rows: true value, columns: told value, both by their enum's number; seconds.
using Confusion = std::array<std::array<double, 4>, 4>;

struct Detection {
  DriverState from;
  DriverState to;
  std::optional<double> after_s;
};

struct DriverStateScore {
  std::size_t drives = 0;
  Confusion state{};          ///< all of the drive
  Confusion state_settled{};  ///< without the first 5 s of every stretch
  Confusion hands{};
  double overlapping_s = 0;           ///< time with an arm whose true J, B, C are those of another state
  std::vector<Detection> detections;  ///< of states; a change of hands alone is none

  [[nodiscard]] double wrong_share(const Confusion& table) const;
  [[nodiscard]] double told_share(const Confusion& table) const;
};

/// What the firmware's limits make of parameters that are exactly known.
[[nodiscard]] DriverState state_of_exact(const WheelArm& arm);

/// Adds one drive to a score.
void score_drive(std::span<const Stretch> truth, std::span<const Estimate> estimates, DriverStateScore& score);

/// Ten subjects at three grips, with a probe of `probe_rms_nm`.
[[nodiscard]] DriverStateScore score_driver_state(
    const ExperimentSettings& settings, const std::vector<VirtualSubject>& subjects, double probe_rms_nm,
    const std::function<void(std::size_t done)>& at_drive = [](std::size_t) {});

inline constexpr std::size_t kTakeOverDrives = 3 * kSubjects;

}  // namespace steerid
