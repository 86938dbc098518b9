// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// How probable every change is, from the sets that a search has fitted.
//
//   P(change) = P(change | the truth is one of the sets) x P(the truth is, as far as this change shows)
//
// The first factor is the change's share of the sets' probabilities (Bayesian model averaging). The second is a
// logistic function: what stands in for something that no set holds gains nats as a right change does, but leaves nats
// open, too, and moves J, B and C; and no simulation of a strong effect is exact. So it takes the logarithm of
//
//   nats that the change gains / (a share of the nats that the answer leaves + nats of a discrepancy that no set holds
//                                 + a share of the nats that all changes gain),
//
// what is left and what is gained counted on the lines on which the change acts (gap/sets/line_nats.hpp), and how far
// J, B and C had to move. A set that has moved them to the limit of their fit speaks of no change. The weights
// (gap/sets/inclusion_calibration.hpp) are fitted to drawn records by scripts/calibrate_inclusion.py; how reliable they
// are stands in docs/results/inclusion_calibration.md.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "gap/sets/searched_sets.hpp"

namespace steerid::gap {

/// Weights of the logistic functions, and the shares of nats that stand in them.
struct InclusionCalibration {
  double changed;    ///< constant of a change
  double ratio;      ///< of the log of nats gained over other nats
  double shift;      ///< of how far J, B and C moved
  double unchanged;  ///< constant of no change
  double of_left;    ///< of nats that are left
  double of_gap;     ///< of nats that all changes gain
};

enum class ChangeKind { kAdd, kResize, kRemove };

[[nodiscard]] std::string_view name(ChangeKind kind);  ///< "add", "resize", "remove"

/// What the probability of a change is made from.
struct ChangeFeatures {
  double among_sets = 0;  ///< the share of the sets that make it, or one of its alternatives, in their probability
  double gain_nats = 0;  ///< log of the best such set's score over that of the best one without it; 1 a record and more
  double left_nats = 0;  ///< that the answer leaves above the floor, and by chance, where the change acts
  double gap_nats = 0;   ///< that the answer gains over J, B and C alone, where the change acts
  double discrepancy_nats = 0;  ///< of something that no set holds (gap/sets/discrepancy.hpp)
  double shift = 0;             ///< of J, B and C (gap/sets/wheel_shift.hpp)
};

struct ChangeInclusion {
  const EffectType* type = nullptr;
  ChangeKind kind = ChangeKind::kAdd;
  double probability = 0;
  ChangeFeatures features{};
  bool refused = false;  ///< the held-out part is simulated better without it: it is not named
};

/// Odds of three to two: a wrong name costs one and a half times what a missing one does.
inline constexpr double kLikely = 0.6;

struct Inclusion {
  std::vector<ChangeInclusion> changes;  ///< every effect that can be added, resized or removed; the likeliest first
  double none = 0;                       ///< that nothing differs, J, B and C neither
  double parameters = 0;                 ///< that only they do
  double unknown = 0;                    ///< that something differs which no set holds
  std::size_t answer = 0;                ///< of the visited sets: the best of those that make likely changes alone
};

/// Of `sets`, which are the sets of the one record, or those that several speak for together (gap/sets/joint_sets.hpp).
/// Nats are sums over the records, whose lines stand behind one another. `discrepancy_nats`: their sum.
[[nodiscard]] Inclusion inclusion_of(const SearchedSets& sets, std::span<const RecordSets> records,
                                     double discrepancy_nats);

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

}  // namespace steerid::gap
