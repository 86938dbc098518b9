// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which changes of a simulation a record speaks for: a search over sets of changes.
//
// It goes in rounds. All moves of a round (gap/sets/set_moves.hpp, additions.hpp) begin at the best set and are judged
// by one evidence; it ends where a round leads to no other set, nor much nearer. After six rounds none adds anything:
// those that follow take back what was added, while that gains.
#pragma once

#include <vector>

#include "gap/sets/searched_sets.hpp"
#include "gap/sets/set_moves.hpp"

namespace steerid::gap {

/// `known`: sets to begin with beside the simulation's, found of the same record under another noise.
[[nodiscard]] SearchedSets search_sets(const SetSetting& setting, const std::vector<Move>& known = {});

/// The simulation's effects as they are, with the J, B and C that suit them best: what a search begins beside.
[[nodiscard]] FittedSet with_free_wheel(const SetSetting& setting);

}  // namespace steerid::gap
