// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Two effects at once, where no single one explains the record.
//
// Two effects of like size leave each other's gap open, so that neither reaches the floor alone. Forward: the best
// single effect first, then every other one fitted jointly with it. Where that does not reach the floor, the second one
// found takes the first one's place and what goes with it is looked for again (the first may have stood in for both),
// in turns as long as much is gained; then the next best single effect has its turn. Two that are both strong hide each
// other from that: they begin where the balance of torques says (gap/pairs/pair_starts.hpp). The kind of a dry friction
// is settled last, with the other effect beside it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gap/attribution/attribution.hpp"
#include "gap/comparison/comparison.hpp"

namespace steerid {

struct CausePair {
  std::string first;
  std::string leading;                   ///< of the two, the one that explains more alone
  std::optional<Effect> first_effect;    ///< none: an unmeasured torque, whose numbers are the floor's
  SlowTorque slow = SlowTorque::kFloor;  ///< what the second one is fitted with
  Candidate second;                      ///< fitted jointly with the first
  Evidence evidence;                     ///< of both together
  double unknown = 1;                    ///< probability that they are not the cause

  /// Whether one of the two is an unmeasured torque.
  [[nodiscard]] bool has_slow_torque() const { return slow == SlowTorque::kCause || second.id == "unmeasured_torque"; }
};

/// An effect with the values that it has beside a second one.
[[nodiscard]] std::optional<Effect> fitted_beside(std::optional<Effect> first, const Candidate& second);

/// The pair that explains the record best, if any explains it as two effects do. `alone` and `singles` are the
/// comparison of single effects, `input` its evidence.
[[nodiscard]] std::optional<CausePair> best_pair(const ComparisonSetting& alone, const Comparison& singles,
                                                 const AttributionInput& input);

}  // namespace steerid
