// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable every change is, from the sets that a search has fitted.
//
// Among the sets a change has the odds of those that make it against those that do not. That is the truth only if one
// of the sets is: what stands in for something that no set holds gains as many nats as a right change. How much is left
// above the floor, which share of the gap that is, and how far J, B and C had to move speak of that. These few features
// go into a logistic function. Its weights (gap/sets/inclusion_calibration.hpp) are fitted to drawn records by
// scripts/calibrate_inclusion.py; how reliable they are stands in docs/results/inclusion_calibration.md.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "gap/sets/set_search.hpp"

namespace steerid {

enum class ChangeKind { kAdd, kResize, kRemove };

[[nodiscard]] std::string_view name(ChangeKind kind);  ///< "add", "resize", "remove"

/// What the calibration knows of a change.
struct ChangeFeatures {
  double log_odds = 0;     ///< of the sets that make it, nats over the dispersion, within +-kMostOdds
  double excess = 1;       ///< of the answer over the floor
  double unexplained = 0;  ///< share of the gap's excess that the answer leaves
  double share = 0;        ///< of the gap's nats that are lost without the change
  double shift = 0;        ///< of J, B and C (gap/sets/wheel_shift.hpp)
  double discrepancy = 0;  ///< nats of something that no set holds (gap/sets/discrepancy.hpp)
  bool revision = false;   ///< of what the simulation has, rather than an addition
  static constexpr double kMostOdds = 1000;
};

struct ChangeInclusion {
  const EffectType* type = nullptr;
  ChangeKind kind = ChangeKind::kAdd;
  double probability = 0;
  ChangeFeatures features{};
};

struct Inclusion {
  std::vector<ChangeInclusion> changes;  ///< every effect that can be added, resized or removed; the likeliest first
  double none = 0;                       ///< that nothing differs, J, B and C neither
  double parameters = 0;                 ///< that only they do
  double unknown = 0;                    ///< that something differs which no set holds
  std::size_t answer = 0;                ///< of the visited sets: the best of those that make likely changes alone
};

[[nodiscard]] Inclusion inclusion_of(const SearchedSets& sets, const SetSetting& setting, double discrepancy);

/// Changes that explain the record as well in the place of one that the set makes: those of the sets whose odds are no
/// worse than 1 to 20 and that differ in it alone.
[[nodiscard]] std::vector<const ChangeInclusion*> in_place_of(const SearchedSets& sets, const FittedSet& one,
                                                              const ChangeInclusion& change,
                                                              const std::vector<ChangeInclusion>& changes);

/// The place of the best of the sets that make no other changes than likely ones. A change is as likely as it is
/// together with those that explain the record as well in its place: an offset of the torque or another weight.
[[nodiscard]] std::size_t likely_answer(const SearchedSets& sets, const std::vector<ChangeInclusion>& changes);

/// Whether the set makes the change.
[[nodiscard]] bool makes(const EffectSet& set, const EffectType& type, ChangeKind kind);

}  // namespace steerid
