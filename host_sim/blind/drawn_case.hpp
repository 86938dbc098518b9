// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One case: a drive with an effect that is drawn, and how far it stands above the noise.
//
// The gap over the floor is refit NRMSE over floor NRMSE: what the best linear wheel leaves of the record, over what it
// leaves of its twin, the same drive with the same disturbances and noise but without the effect, both in radians. Its
// logarithm is drawn evenly between 1.5 and 25, and the effect's size set to it as far as its physical range goes.
//
// Wide nuisance: J, B, C over the paper's tables, 60 to 100 s, noise, slow unseen torque of at most 2 % of the applied
// torque's rms in four records of five. The simulation's J, B, C are exact for `none` and where all of its effects are,
// off by 20 to 60 % for `parameters`, by up to 8 % otherwise.
//
// Where the simulation has effects the gap is between the wheel and the same drive of the simulation: what is left of
// their difference when no J, B and C can make up for it. Every change that is to be found has a gap of kSmallestGap at
// least by itself, or the case is drawn anew. A remainder, an effect outside the vocabulary beside others, has a gap
// of 1.5 to 6. An effect of another size is 0.4 to 0.65 or 1.5 to 2.5 times as large.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blind/contents.hpp"
#include "blind/kind.hpp"
#include "blind/simulation.hpp"

namespace steerid::blind {

struct DrawnEffect {
  std::string id;
  Numbers numbers;
};

struct DrawnCase {
  std::string label;  ///< the verdict that would be right: an id of the vocabulary, none, parameters or unknown
  Contents contents;
  std::vector<DrawnEffect> effects;    ///< of the wheel
  std::vector<DrawnEffect> simulated;  ///< of the simulation
  Task task = Task::kProbe;
  Arm arm;
  Arm simulation;  ///< what sim.json says
  Sensors sensors;
  double duration_s = 0;
  double unseen_rms_nm = 0;
  double wheel_inertia_share = 0;
  double wheel_damping_share = 0;
  std::uint64_t seed = 0;
  double gap_over_floor = 1;
  double floor_nrmse = 0;
  double refit_nrmse = 0;
  Arm linear_fit;
  Record record;
};

/// The same seed and contents give the same case. `held`: every wheel is held by a position loop, which is drawn, too.
[[nodiscard]] DrawnCase draw_case(const Contents& contents, std::uint64_t seed, bool held = false);

}  // namespace steerid::blind
