// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What is valid, and what of that is wrong (study/arm_score.hpp), over all the kinds of drives that a study has.
#pragma once

#include "study/findings.hpp"

namespace steerid {

/// Of the valid ticks of a parameter, in any kind of drive: what may be wrong, and for how long at a stretch.
inline constexpr double kMostWrong_percent = 2;
inline constexpr double kLongestWrong_s = 3;

/// Table "over_kinds", a row for each torque and parameter of `table`: means of `valid_percent` and of
/// `wrong_of_valid_percent` over the kinds, the longest `longest_wrong_s` of any, and in how many kinds more than
/// kMostWrong_percent of what is valid is wrong. A kind in which nothing is valid has nothing wrong.
/// `table` has these three columns, and a row for each kind, torque and parameter, named by its first three cells.
/// Throws std::out_of_range where it has not.
[[nodiscard]] FoundTable over_kinds(const FoundTable& table);

}  // namespace steerid
