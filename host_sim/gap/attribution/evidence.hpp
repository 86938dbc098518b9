// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What the comparison of hypotheses says about one id, in the terms of the attribution
// (gap/attribution/attribution.hpp). Nats are of minus log likelihood; an excess is the misfit over what the floor
// leaves, 1 at the floor.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gap/comparison/rivals.hpp"

namespace steerid {

struct Evidence {
  std::string id;
  double fit_nats = 0;         ///< minus log likelihood on the fitted blocks, priors included
  double choose_nats = 0;      ///< on the blocks that choose
  double complexity = 0;       ///< log(lines)/2 for every free parameter
  double shift = 0;            ///< of J, B, C from the simulation's: sum of log(1 + (relative change/0.06)^2)
  double shift_at_least = 0;   ///< of J, B, C three deviations nearer to the simulation's
  double excess = 1;           ///< over both kinds of blocks
  double slow_share = 0;       ///< slow torque of its floor over the applied torque; 0 where that is a cause
  double slow_missed = 0;      ///< likewise, what its run misses (gap/model/slow_in_run.hpp); 0 where not asked
  double slow_line_share = 0;  ///< how much of an unmeasured torque is a single tone (gap/likelihood/slow_line.hpp)
  double beyond_coulomb = 0;   ///< of a kind of dry friction: what it has beyond Coulomb's, over the applied torque
  double lines = 0;            ///< degrees of freedom / 2 of both
  bool eligible =
      true;  ///< false: what it found is part of the floor by definition, or its fit lies impossibly far below it
  bool at_bound = false;   ///< a number of the effect stands at the upper end of its range, as a stand-in's does
  bool simulated = false;  ///< free runs had a say
  bool switches = false;   ///< play, absence or no spring: a simulation states them more simply than a machine does
  std::vector<Rival> rivals{};
  std::optional<double> run_error{};  ///< share of the gap's power that its free run leaves open; unseen part
};

}  // namespace steerid
