// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How soon it is told that nobody holds the wheel, and how often it is told of a wheel that is held: by the flashed
// task and, on the very same drives, by what production cars do.
//
//   steerid      driver state `hands_off`
//   threshold    the size of the torsion bar's torque behind a low pass of 1 Hz is below 0.3, 0.5, 0.7 or 1 Nm
//
// Either must say so for a time without a break before it is told, 0 to 12 s: that time makes the curve of each. UN
// Regulation 79 (revision 4, 5.6.2.2.5) allows 15 s before the warning.
//
// Drives, each of 60 s with a probe of 0.5 Nm rms from 0.2 to 6 Hz, of the project's own column with a self-aligning
// stiffness of 2 to 25 Nm/rad (any speed), half of them on a rough road (1 to 2.5 Nm rms up to 8 Hz, otherwise 0.03 to
// 0.3 Nm up to 3 Hz):
//
//   release      the hands leave for 15 s after some 20 s
//   held         an arm that steers by 0.01 to 0.1 rad rms, or, in half of them, two fingers: a spring of 0.8 to 3
//   Nm/rad
//                with 3 to 10 gm2 and 0.05 to 0.2 Nms/rad
//   braced       a relaxed arm of 6 to 11 Nm/rad braces threefold within a second and stays so
//
// The releases of the held-out generator stand beside them. A false alarm that comes back within 5 s is the same one;
// one that is on when the hands leave counts as told at once.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct HandsStudy {
  std::size_t drives = 100;  ///< releases, held-out releases and arms that brace, of each
  std::size_t hours = 20;    ///< of held wheels
  std::uint64_t seed = 1;
};

/// Figures: tables "hands", of every time for which a detector must have said so; "braced"; and "states", what is told
/// of a wheel by who holds it.
[[nodiscard]] Findings run_hands_study(const HandsStudy& study, const StudyProgress& at);

}  // namespace steerid
