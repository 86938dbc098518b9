// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Which changes of a simulation a record speaks for: a search over sets of changes.
//
// The moves are: J, B and C free; an effect of the simulation resized or removed; an effect added; a change that was
// made taken back; an effect exchanged for another of its family. Additions are sorted by score tests: what is left,
// projected on what a candidate would move, what the free numbers can do projected out of both
// (gap/sets/spectral_search.hpp). Those that promise less than a new number costs are not fitted. Every set that
// was fitted counts in the end: a change is as probable as the sets that make it (Bayesian model averaging; Hoeting et
// al., Statistical Science 14, 1999).
#pragma once

#include <string_view>
#include <vector>

#include "gap/sets/set_fit.hpp"

namespace steerid {

struct SearchedSets {
  std::vector<FittedSet> visited;  ///< the first is the simulation as it is, the second it with J, B and C free
  std::size_t best = 0;
  double dispersion = 1;

  [[nodiscard]] const FittedSet& answer() const { return visited[best]; }
  /// The one with these changes; null where it was not visited.
  [[nodiscard]] const FittedSet* find(const EffectSet& set) const;
  /// Log of evidence times prior.
  [[nodiscard]] double score(const FittedSet& one) const;
  /// The sets' probabilities, in the order of `visited`.
  [[nodiscard]] std::vector<double> probabilities() const;
  /// Sets `dispersion` and `best` by what was visited.
  void rank();
};

[[nodiscard]] SearchedSets search_sets(const SetSetting& setting);

}  // namespace steerid
