// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// One case: a drive with an effect that is drawn, and how far it stands above the floor.
//
// The gap over the floor is refit NRMSE over floor NRMSE: what the best linear wheel leaves of the record, over what it
// leaves of its twin, the same drive with the same disturbances and noise but without the effect, both in radians. Its
// logarithm is drawn evenly between 1.5 and 25, and the effect's size set to it as far as its physical range goes.
//
// Wide nuisance: J, B, C over the paper's tables, 60 to 100 s, noise, slow unseen torque of at most 2 % of the applied
// torque's rms in four records of five. The simulation's J, B, C are exact for `none`, off by 20 to 60 % for
// `parameters`, by up to 8 % otherwise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blind/kind.hpp"
#include "blind/simulation.hpp"

namespace steerid::blind {

struct DrawnEffect {
  std::string id;
  Numbers numbers;
};

struct DrawnCase {
  std::string label;  ///< the verdict that would be right: an id of the vocabulary, none, parameters or unknown
  std::vector<DrawnEffect> effects;
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

/// What is to be in a case: none, parameters, or the ids of one or two effects.
using Contents = std::vector<std::string>;

/// `count` contents in an order that the seed decides. A deck holds every effect of the vocabulary twice, `none` and
/// `parameters` four times each and every effect outside the vocabulary once; decks follow each other.
[[nodiscard]] std::vector<Contents> draw_contents(std::size_t count, std::uint64_t seed);
/// Two effects of the vocabulary at once, of different families.
[[nodiscard]] std::vector<Contents> draw_pairs(std::size_t count, std::uint64_t seed);

/// The same seed and contents give the same case. `held`: every wheel is held by a position loop, which is drawn, too.
[[nodiscard]] DrawnCase draw_case(const Contents& contents, std::uint64_t seed, bool held = false);

}  // namespace steerid::blind
