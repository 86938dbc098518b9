// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How well the flashed task identifies the arm of a driver who steers, from the torsion bar and a probe.
//
//   arms       a probe of 1 Nm, a driver who means 0.03, 0.1 or 0.2 rad rms (a third of the drives each): what becomes
//   of
//              the arm, drawn and held out
//   steering   arms that stay: every steering with every probe; error after 30 s over the bound
//   alike      the drives of `arms` in float and in fixed point: share of ticks that differ
//
// All shares are of the ticks after 5 s. "Close", "wrong": study/arm_score.hpp. The bound is that by the probe
// (study/probe_bound.hpp). "Reachable" is the share that an estimator at the bound has within 15 %, all ticks valid:
// the bound uses what came before, and knows how the arm walks.
#pragma once

#include <cstddef>
#include <cstdint>

#include "study/findings.hpp"

namespace steerid {

struct ColumnStudy {
  std::size_t drives = 48;  ///< of 60 s, in each case
  std::uint64_t seed = 1;
};

/// Figures: tables "arms", "steering" and "alike".
[[nodiscard]] Findings run_column_study(const ColumnStudy& study, const StudyProgress& at);

}  // namespace steerid
