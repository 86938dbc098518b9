// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether what is called valid is right, over hours of drives of the held-out generator (blind/column_drive.hpp), by
// what happens in them.
//
//   arm        stays; wanders, braces, second hands, B that falls; all of them (an ordinary hour)
//   change     one in a minute: C ramps, C swings, a second hand comes, hands leave
//   record     samples 6 to 14 ms apart and stamped so; faults of the sensors; a road load below the bar
//   hidden     30 % of the driver's torque that no sensor sees, where all of it is said to be known
//
// Each once with all torque known (a steady probe of 0.4 Nm rms, in drives of a minute 1 Nm) and once from the torsion
// bar (a probe of 1 Nm), with a driver who means 0.01 to 0.1 rad rms, at most 4 Nm rms.
//
// "All" counts a tick as valid when J, B and C are, and as wrong when one of them is (study/arm_score.hpp). Lag: that
// of study/following.hpp, in the median drive, of what changes and is never 0.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct ValidityStudy {
  std::size_t drives = 12;   ///< of each kind, in each of the two worlds
  std::size_t minutes = 10;  ///< each but those of one change; below four not every kind happens
  std::uint64_t seed = 1;
};

/// Figures: tables "validity" and "over_kinds".
[[nodiscard]] Findings run_validity_study(const ValidityStudy& study, const StudyProgress& at);

}  // namespace steerid
