// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Sets of changes that were fitted to a record, and how probable each is.
//
// Every set that was fitted counts: a change is as probable as the sets that make it (Bayesian model averaging; Hoeting
// et al., Statistical Science 14, 1999).
#pragma once

#include <vector>

#include "gap/sets/set_fit.hpp"

namespace steerid::gap {

struct SearchedSets {
  std::vector<FittedSet> visited;  ///< the first is the simulation as it is, the second it with J, B and C free
  std::size_t best = 0;
  double dispersion = 1;  ///< what nats are divided by

  [[nodiscard]] const FittedSet& answer() const { return visited[best]; }
  /// The one with these changes; null where it was not visited.
  [[nodiscard]] const FittedSet* find(const EffectSet& set) const;
  /// The one that leaves least, whatever it costs.
  [[nodiscard]] const FittedSet& nearest() const;
  /// Log of evidence times prior.
  [[nodiscard]] double score(const FittedSet& one) const { return score(one, dispersion); }
  [[nodiscard]] static double score(const FittedSet& one, double dispersion);
  /// The sets' probabilities, in the order of `visited`.
  [[nodiscard]] std::vector<double> probabilities() const;
  /// Sets `dispersion` and `best` as a search goes on: to the excess of the nearest set.
  void rank();
  /// The same to judge by: where no set is the truth, details of what is left decide between two that are near it.
  /// Nats are divided by how many times chance the nearest set leaves (the coarsened posterior; Miller and Dunson,
  /// Journal of the American Statistical Association 114, 2019). An effect of a kind of friction on a wheel whose
  /// friction is neither is then told by the nats that it gains of those that are left, not by their number.
  void judge();

 private:
  void rank_by(double by);
};

/// What was searched for one record.
struct RecordSets {
  const SetSetting& setting;
  SearchedSets& sets;
};

}  // namespace steerid::gap
