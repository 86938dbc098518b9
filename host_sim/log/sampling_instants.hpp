// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Whether samples were taken when their stamps say, or evenly, by a clock, and stamped when they arrived.
//
// A logger that stamps what comes off a bus stamps it late, by a time that changes from sample to sample and may be
// several periods long: what waited meanwhile is then stamped all at once. Reading such a record off its stamps adds
// noise, rate times stray, where the samples themselves are even; reading one off an even grid whose samples stray does
// the same. The samples tell. With t_i = g_i + stray_i and x' the slope,
//
//   x_i = x(g_i) + s x'_i stray_i        s = 1: taken at the stamps; s = 0: taken evenly
//
// and what every sample is off the cubic through its neighbours (no drive is fast enough to be in that) is regressed on
// what s = 1 would make it, channels together, weighted by what they know; stray_i is that against the neighbours'.
// Above one half the stamps count, else the grid does. Stamps that stray slowly, by a clock that wanders, tell nothing
// and are left as they are.
//
// Grid. Every sample has a place of its own, later than that of the one before: sample i stands at t_0 + P (i + m_i)
// with m_i the samples that were lost before it. A stamp that is late by itself is a stray; samples were lost where an
// interval is nearer to two periods than to one and from it on all stamps are later: by the lower quartiles of the 10,
// and of the 30, before and after it, so that what a stall of up to 20 samples holds up is no loss; and where the
// samples around it bend less with a hole than without. These are not asked where next to no interval is nearer to one
// and a half periods than to a whole number of them: such stamps are the samples' own. A clock that wanders, or slips
// by less than half a period, is not followed: it is the logger's, not the samples'.
//
// Cost: some 10 ns a sample.
#pragma once

#include <span>
#include <vector>

namespace steerid {

/// The period of the clock behind `time_s`, strictly increasing, of which samples may have been lost. `about_s`: known
/// to a tenth. The median over spans of 1, 2, 4, ... samples, each of which tells how many periods the next longer ones
/// hold (as a phase is unwrapped: Tretter, IEEE Trans. Inf. Theory 31, 1985); of these the one whose median is known
/// best. Where every stamp strays by itself that is the longest; where a logger slips now and then, for good, it is the
/// single interval, most of which have no slip. A round rate between the least and the largest of these medians is
/// taken as it is, unless `any_rate`: stamps that are rows' are no clock's that somebody set.
[[nodiscard]] double clock_period_s(const std::vector<double>& time_s, double about_s, bool any_rate = false);

/// Of samples by a clock of `period_s`; `channels` have one value a stamp, or none. True where the samples are even and
/// the stamps stray from that; false where they are not, or where nothing tells.
[[nodiscard]] bool evenly_sampled(const std::vector<double>& time_s, double period_s,
                                  std::span<const std::vector<double>> channels);

/// The stamps of the even grid: whole periods after the first stamp, no two the same. A lost sample leaves its place
/// empty.
[[nodiscard]] std::vector<double> even_stamps(const std::vector<double>& time_s, double period_s,
                                              std::span<const std::vector<double>> channels);

}  // namespace steerid
