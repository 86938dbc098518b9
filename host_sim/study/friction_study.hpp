// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What dry friction above the torsion bar costs, and what is left of that once the task is told its size
// (identifier/wheel_friction.hpp): the arm's B, and whether hands that have left are told.
//
//   arm       stays, a driver of 0.05 rad rms, probe of 1 Nm rms, 60 s: the held-out generator, whose bearing is one of
//             Dahl's, with bristles of 0.1 to 1 mrad
//   release   the same with 0.5 Nm, hands that leave for 8 to 15 s
//   held      the project's own column, which sticks and slips, as in study/hands.hpp: an arm or two fingers
//
// All with the same seeds for every size of friction, so that the rows differ by the friction alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct FrictionStudy {
  std::size_t drives = 100;  ///< of arms, releases and held wheels each, for every size
  std::uint64_t seed = 1;
};

/// Figures: the table "friction", a row for each size that the task is told of, or is not.
[[nodiscard]] Findings run_friction_study(const FrictionStudy& study, const StudyProgress& at);

}  // namespace steerid
