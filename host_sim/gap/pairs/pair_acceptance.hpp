// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// When a second effect is named: it has to gain more than a better optimum of the first one would.
#pragma once

#include <optional>
#include <vector>

#include "gap/pairs/pair_search.hpp"

namespace steerid {

/// What is left above this excess is worth a name of its own.
inline constexpr double kWorthAName = 1.5;

/// Whether a further effect closes most of what is left above the floor. `excess` and `nats` are what is there without
/// it.
[[nodiscard]] bool gains_enough(double excess, double nats, const Evidence& by);

/// The same beside a defect of the record, from nearer the floor on. Its repair leaves what no effect explains: a free
/// run that closes most of the gap will do, too. `refit` is the wheel without an effect.
[[nodiscard]] bool gains_beside_defects(const Evidence& refit, const Evidence& by);

/// The same beside a coarse angle alone: its floor is that of the rounding, which hides much of what is there.
[[nodiscard]] bool gains_beside_rounding(const Evidence& refit, const Evidence& by);

/// The pair that explains the record better than any single effect, or than `unknown`, if there is one. `alone` and
/// `singles` are the comparison of single effects, `input` and `probability` its attribution; the latter becomes the
/// pair's where the pair takes the place of what was most probable.
[[nodiscard]] std::optional<CausePair> pair_instead(const ComparisonSetting& alone, const Comparison& singles,
                                                    const AttributionInput& input, std::vector<double>& probability);

}  // namespace steerid
