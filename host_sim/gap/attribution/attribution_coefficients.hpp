// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How much each part of the evidence counts (gap/attribution/attribution.hpp). Set by hand on labelled records.
#pragma once

#include "gap/attribution/attribution.hpp"

namespace steerid {

inline constexpr AttributionCoefficients kAttribution = {
    .fit = 0.5,
    .choose = 0.5,
    .complexity = 1.0,
    .shift = 1.0,
    .dispersion_power = 1.0,
    .none = 2.0,
    .unknown_odds = 1.5,
    .unknown_sharpness = 4.0,
    .unknown_excess = 0.55,
    .unknown_unclosed = 0.13,
    .family = {.nats = 12.0, .share = 0.5},
    .shape = {.nats = 5.0, .share = 0.25},
};

/// Of two effects at once. They have to gain enough besides (gap/pairs/pair_acceptance.hpp).
inline constexpr AttributionCoefficients kPairAttribution = [] {
  AttributionCoefficients pair = kAttribution;
  pair.unknown_odds = 1;
  return pair;
}();

}  // namespace steerid
