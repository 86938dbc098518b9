// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// What of a simulation as it is has to change: the search over sets of changes (gap/sets), as a diagnosis asks it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.hpp"
#include "gap/diagnosis/final_fit.hpp"
#include "gap/preparation/prepared_record.hpp"
#include "gap/sets/inclusion.hpp"

namespace steerid::gap {

class SetAnswer {
 public:
  SetAnswer(PreparedRecord& prepared, const Simulation& simulation, const DiagnoseOptions& options);

  /// Comes before all that follows. The record is prepared anew where what is found changes what its noise is.
  void search();
  [[nodiscard]] bool searched() const { return sets_.has_value(); }

  [[nodiscard]] const Inclusion& inclusion() const { return inclusion_; }
  [[nodiscard]] const SetSetting& setting() const { return *setting_; }
  /// What the answer is chosen from: the sets of all records of the wheel, where there are several.
  [[nodiscard]] const SearchedSets& judged() const { return joint_ ? *joint_ : *sets_; }
  /// A set as it was fitted to this record.
  [[nodiscard]] const FittedSet& own(const FittedSet& one) const {
    const FittedSet* same = sets_->find(one.set);
    return same != nullptr ? *same : one;
  }
  [[nodiscard]] std::vector<RankedEffect> ranking(const std::vector<RecordDefect>& defects) const;
  /// none, parameters, unknown, or the id of what is changed first.
  [[nodiscard]] std::string verdict() const;

  /// The set that is named, J, B and C free.
  [[nodiscard]] const FittedSet& named() const;
  /// The simulation's effects as they are, with the J, B and C that suit them best.
  [[nodiscard]] const FittedSet& refit() const { return sets_->visited[1]; }
  [[nodiscard]] FinalFit final_fit() const;
  /// By this record alone; none where it has no sizes in common with others.
  [[nodiscard]] std::optional<FinalFit> fit_alone() const;
  /// What the set that is named changes, in the vocabulary's order; without intervals and what it closes. An unmeasured
  /// torque has no course yet.
  [[nodiscard]] std::vector<Cause> changes() const;
  /// Takes the best set for what comes nearest to something unknown; false where it changes nothing.
  bool take_surrogate();
  /// Takes nothing for it again.
  void refuse_surrogate();
  /// Whether the best set needs J, B and C further from the simulation's than simulations are off.
  [[nodiscard]] bool wheel_out_of_place() const;
  /// Effects that explain the record as well in the place of one that is named.
  [[nodiscard]] std::vector<std::string> equivalents() const;
  /// Every set that was fitted, the likeliest first.
  [[nodiscard]] std::vector<SetEvidence> evidence() const;
  /// The change is not named, whatever the evidence says.
  void refuse(const EffectType& type);
  /// Nor are J, B and C alone. What they explain of the record is something unknown's, or nothing where the simulation
  /// is right `as_given`.
  void refuse_wheel(bool as_given);

  /// The answer is `unknown` whatever the evidence says: no change is believed, nor that the simulation is right.
  void believe_nothing();

  /// Several records of one wheel: from here on each answers by the evidence of all (gap/sets/joint_sets.hpp).
  static void join(std::span<SetAnswer* const> records);
  /// After that: the set that is named gets the sizes that the records have in common (gap/sets/shared_sizes.hpp).
  static void share_named(std::span<SetAnswer* const> records);

 private:
  [[nodiscard]] static std::vector<RecordSets> sets_of(std::span<SetAnswer* const> records);
  void search_once();
  /// What is searched, and by which noise.
  void set_up();
  /// Searches again with the torque above 1 Hz as noise that the answer's rest speaks for, if any, where nothing is
  /// left of the answer beside it: it is at the noise level then, and no shape without a name has strong evidence. The
  /// same has to hold of the new answer. A driver's torque leaves nothing; what else is missing follows the motion, and
  /// no noise holds all of it.
  void allow_for_fast_torque();

  PreparedRecord& prepared_;
  const Simulation& simulation_;
  const DiagnoseOptions& options_;
  std::optional<SetSetting> setting_;
  std::optional<SearchedSets> sets_;
  std::shared_ptr<const SearchedSets> joint_;  ///< of all records of the wheel; none where there is one
  double discrepancy_nats_ = 0;
  Inclusion inclusion_;
};

}  // namespace steerid::gap
