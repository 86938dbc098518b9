// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How the flashed task follows an arm that changes: ramps and steps of C, there and back, swings, B alone, B with C, a
// second hand; once with all torque known and once as a car has it, on the very same drives.
//
// Drives: the project's own column with a probe of 1 Nm rms and a driver who means 0.1 rad rms, at most 4 Nm rms at the
// arm's stiffest (study/labelled_drive.hpp). The change begins at 20 s and is judged until 15 s after its end.
//
//   known   the sensor of the driver's voluntary torque (30 mNm of noise) beside that of the bar: all torque is known
//   bar     torsion bar and probe
//
// Beside the errors stands the bound of a smoother that knows how much the arm walks (study/probe_bound.hpp): with all
// torque known the whole motion is its instrument, else what the probe causes. It uses the future, the task cannot.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct ArmChangesStudy {
  std::size_t drives = 24;  ///< in each case
  std::uint64_t seed = 1;
  double angle_offset_rad = 0;  ///< of the angle's sensor, in every drive
};

/// How many jobs run_arm_changes() tells of.
[[nodiscard]] std::size_t arm_change_jobs(const ArmChangesStudy& study);

/// Adds the tables "changes" (following and states), "alike" (fixed point against float) and "over_kinds"
/// (study/over_kinds.hpp), and what is asked of them.
void add_arm_changes(Findings& found, const ArmChangesStudy& study, const StudyProgress& at);

}  // namespace steerid
