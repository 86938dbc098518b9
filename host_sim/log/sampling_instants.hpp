// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether samples were taken when their stamps say, or evenly, by a clock, and stamped when they arrived.
//
// A logger that stamps what comes off a bus stamps it late, by a part of a period that changes from sample to sample.
// Reading such a record off its stamps adds noise, rate times stray, where the samples themselves are even; reading one
// off an even grid whose samples stray does the same. The samples tell. With t_i = g_i + stray_i and x' the slope,
//
//   x_i = x(g_i) + s x'_i stray_i        s = 1: taken at the stamps; s = 0: taken evenly
//
// and what every sample is off the cubic through its neighbours (no drive is fast enough to be in that) is regressed on
// what s = 1 would make it, channels together, weighted by what they know. Above one half the stamps count, else the
// grid does. Stamps that stray slowly, by a clock that wanders, tell nothing and are left as they are.
#pragma once

#include <span>
#include <vector>

namespace steerid {

/// Of a stretch without gaps whose mean interval is `period_s`; `channels` have one value a stamp, or none. True where
/// the samples are even and the stamps stray from that; false where they are not, or where nothing tells.
[[nodiscard]] bool evenly_sampled(const std::vector<double>& time_s, double period_s,
                                  std::span<const std::vector<double>> channels);

/// The stamps of the even grid: whole periods after the first. A lost sample leaves its place empty.
[[nodiscard]] std::vector<double> even_stamps(const std::vector<double>& time_s, double period_s);

}  // namespace steerid
